#pragma once
/// \file edge_detection.hpp  Third-order edges in plain C++ and double precision: the oracle of the device stage.
/// doc/method.md section 1.

#include <array>
#include <cstdint>
#include <vector>

#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"

namespace quadedge::reference {

/// Edges in scan order, with the pixel that won the maximum test.
struct ReferenceEdges {
  std::vector<double> x, y;                    ///< pixels
  std::vector<double> direction;               ///< radians in (-pi, pi]; the bright side lies at (-sin, cos)
  std::vector<double> strength;                ///< peak gradient magnitude, grey levels per pixel
  std::vector<double> scale_drift;             ///< towards the bright side per unit of log(sigma), pixels
  std::vector<double> gradient_x, gradient_y;  ///< unit gradient at the pixel that won
  std::vector<double> peak_x, peak_y;          ///< the parabola's peak, before the Newton step, pixels
  std::vector<std::int32_t> column, row;       ///< of the pixel that won
  std::vector<std::int32_t> row_first;         ///< as in EdgeSet, size height + 1

  std::size_t size() const { return x.size(); }
};

/// Image gradient, grey levels per pixel, row-major.
struct GradientField {
  int width = 0, height = 0;
  std::vector<double> ix, iy;

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
  }
  double magnitude(int column, int row) const;
};

/// The gradient magnitude at a pixel and one step ahead and behind along the gradient, linearly interpolated on the
/// ring of the eight neighbours; `step` is the distance of the two probes [px].
struct Probe {
  double magnitude = 0, ahead = 0, behind = 0, step = 1;
  double gx = 0, gy = 0;  ///< unit gradient

  /// Of equal neighbours along the gradient, only the first one is a maximum.
  bool is_maximum() const { return magnitude > behind && magnitude >= ahead; }
};

/// Derivatives of the smoothed image at one point, grey levels and pixels.
struct Derivatives {
  double ix, iy, ixx, ixy, iyy, ixxx, ixxy, ixyy, iyyy, ixxxx, ixxxy, ixxyy, ixyyy, iyyyy;
};

/// \throws UsageError for an empty image.
GradientField gradient_field(ImageView image, const EdgesConfig& config);

/// The pixel must not lie on the rim of the field and must have a gradient.
Probe probe_maximum(const GradientField& field, int column, int row);

/// Kernels re-centred at (x, y): 2 R + 2 taps per axis beginning at floor(x) - R. Grey levels are taken relative to the
/// mean of the four pixels around the point, because the truncated tails of an off-centre kernel would respond to the
/// absolute level.
Derivatives derivatives_at(ImageView image, double x, double y, double sigma);

/// Gradient of F = grad(I)^T Hess(I) grad(I), which is normal to the edge and points to its dark side (doc/method.md
/// section 1).
std::array<double, 2> gradient_of_f(const Derivatives& d);

/// Third-order edges of an image of any size (too small for the margin: none) whose gradient exceeds `threshold` [grey
/// levels per px]. max_edges is ignored.
ReferenceEdges detect_edges(const ImageView& image, const EdgesConfig& config, double threshold);

EdgeSet to_edge_set(const ReferenceEdges& edges);

/// The first `most` of them; the number of others is added to `dropped`.
EdgeSet first_edges(const ReferenceEdges& all, int most, int& dropped);

}  // namespace quadedge::reference
