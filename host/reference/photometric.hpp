#pragma once
/// \file photometric.hpp  Plain C++ twin of kernels/photometric.cl, double precision.

#include <array>

#include "quadedge/image.hpp"

namespace quadedge::reference {

using PatchValues = std::array<double, 49>;

/// Where a 7 x 7 side patch lies: its first sample, steps (cosine, sine) along the tangent and (-sine, cosine) to the bright side.
struct PatchFrame {
  double x, y, cosine, sine;
};

/// `side`: +1 dark, -1 bright; `offset` px from the edge to the patch centre.
PatchFrame patch_frame(double x, double y, double cosine, double sine, double side, double offset);

/// Bilinear grey level, coordinates clamped to the border.
double grey_at(const ImageView& image, double x, double y);

/// Mean-free grey levels of a patch moved by (dx, dy); element 7 i + j.
PatchValues cut_patch(const ImageView& image, const PatchFrame& frame, double dx, double dy);

/// Mean-free derivative along the unit vector (ex, ey): central difference over 1 px [grey levels per px].
PatchValues patch_derivative(const ImageView& image, const PatchFrame& frame, double ex, double ey);

/// Settings of the Gauss-Newton loops.
struct RefinementSettings {
  int steps;
  double tolerance;  ///< px
  double huber;      ///< grey levels
  double clamp;      ///< px
  double rms_max;    ///< grey levels
  double stiffness = 0;  ///< of a prior around the start [grey levels^2 / px^2]
};

/// Outcome of an alignment.
struct Alignment {
  bool good = false;  ///< neither diverged nor left with a large residual
  double alpha = 0;   ///< move along the line [px]
  double rms = 0;     ///< of the last residual evaluated [grey levels]
};

/// Weight of the Huber loss.
double huber_weight(double residual, double limit);

/// Gauss-Newton on the move along (ex, ey) that makes the patch at `moving` look like `fixed`, whose derivative along the move
/// is `derivative` (SPEC section 3, 8b).
Alignment align_along_line(const ImageView& image, const PatchFrame& moving, double ex, double ey, const PatchValues& fixed,
                           const PatchValues& derivative, const RefinementSettings& settings);

}  // namespace quadedge::reference
