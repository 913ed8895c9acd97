#pragma once
/// \file photometric.hpp  Plain C++ twin of kernels/photometric.cl, double precision.

#include <array>
#include <optional>

#include "common/layouts.hpp"
#include "quadedge/image.hpp"

namespace quadedge::reference {

using PatchValues = std::array<double, kPatchSamples>;

/// Where a patch lies: its first sample, rows of 7 samples along (-sine, cosine) to the bright side, 1 px apart, and
/// kPatchRowStep px along the tangent (cosine, sine) from row to row.
struct PatchFrame {
  double x, y, cosine, sine;
};

/// `side`: +1 dark, -1 bright, 0 on the edge itself; `offset` px from the edge to the patch centre.
PatchFrame patch_frame(double x, double y, double cosine, double sine, double side, double offset);

/// Bilinear grey level, coordinates clamped to the border.
double grey_at(const ImageView& image, double x, double y);

/// Mean-free grey levels of a patch moved by (dx, dy); element kPatchSide i + j.
PatchValues cut_patch(const ImageView& image, const PatchFrame& frame, double dx, double dy);

/// Mean-free derivative along the unit vector (ex, ey): central difference over 1 px [grey levels per px].
PatchValues patch_derivative(const ImageView& image, const PatchFrame& frame, double ex, double ey);

/// Settings of the Gauss-Newton loop.
struct RefinementSettings {
  int steps;
  double tolerance;  ///< px
  double huber;      ///< grey levels
  double clamp;      ///< px
};

/// Weight of the Huber loss.
double huber_weight(double residual, double limit);

/// Root of the sum of squares.
double patch_norm(const PatchValues& values);

/// NCC of two mean-free patches; 0 where one of them is flat.
double patch_ncc(const PatchValues& a, const PatchValues& b);

/// Result of the alignment of an edge.
struct Alignment {
  double move;         ///< px
  PatchValues values;  ///< the patch there, or less than the tolerance before it
};

/// Gauss-Newton on the move along (ex, ey) that makes the patch at `moving`, at equal contrast, look like `fixed`,
/// whose derivative along the move is `derivative` (doc/method.md section 3, 8b). A prior of `stiffness` [grey levels^2
/// / px^2] holds it around the start. \returns nothing if the move exceeds the clamp.
std::optional<Alignment> align_edge(const ImageView& image, const PatchFrame& moving, double ex, double ey,
                                    const PatchValues& fixed, const PatchValues& derivative, double stiffness,
                                    const RefinementSettings& settings);

}  // namespace quadedge::reference
