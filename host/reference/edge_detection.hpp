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

/// Edges in scan order of the doubled grid, with the grid cell that won the maximum test.
struct ReferenceEdges {
  std::vector<double> x, y;                    ///< pixels
  std::vector<double> direction;               ///< radians in (-pi, pi]; the bright side lies at (-sin, cos)
  std::vector<double> strength;                ///< peak gradient magnitude, grey levels per pixel
  std::vector<double> scale_drift;             ///< towards the bright side per unit of log(sigma), pixels
  std::vector<double> gradient_x, gradient_y;  ///< unit gradient at the cell that won
  std::vector<double> peak_x, peak_y;          ///< the parabola's peak, before the Newton step, pixels
  std::vector<std::int32_t> cell_x, cell_y;    ///< cell (2 i, 2 j) of the doubled grid is pixel (i, j)
  std::vector<std::int32_t> row_first;         ///< as in EdgeSet, size 2 * height + 1

  std::size_t size() const { return x.size(); }
};

/// Image gradient on the doubled grid, grey levels per pixel. (2 height - 1) x (2 width - 1) cells, row-major.
struct GradientField {
  int columns = 0, rows = 0;
  std::vector<double> ix, iy;

  std::size_t index(int cell_x, int cell_y) const {
    return static_cast<std::size_t>(cell_y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(cell_x);
  }
  double magnitude(int cell_x, int cell_y) const;
};

/// The gradient magnitude at a cell and one step ahead and behind along the gradient, linearly interpolated on the ring
/// of the eight neighbours; `step` is the distance of the two probes in grid steps.
struct Probe {
  double magnitude = 0, ahead = 0, behind = 0, step = 1;
  double gx = 0, gy = 0;  ///< unit gradient

  /// No smaller than either probe and larger than one.
  bool is_maximum() const {
    return (magnitude > behind && magnitude >= ahead) || (magnitude >= behind && magnitude > ahead);
  }
};

/// Derivatives of the smoothed image at one point, grey levels and pixels.
struct Derivatives {
  double ix, iy, ixx, ixy, iyy, ixxx, ixxy, ixyy, iyyy, ixxxx, ixxxy, ixxyy, ixyyy, iyyyy;
};

/// \throws UsageError for an empty image.
GradientField gradient_field(ImageView image, const EdgesConfig& config);

/// The cell must not lie on the rim of the field and must have a gradient.
Probe probe_maximum(const GradientField& field, int cell_x, int cell_y);

/// Kernels re-centred at (x, y): 2 R + 2 taps per axis beginning at floor(x) - R. Grey levels are taken relative to the
/// mean of the four pixels around the point, because the truncated tails of an off-centre kernel would respond to the
/// absolute level.
Derivatives derivatives_at(ImageView image, double x, double y, double sigma);

/// Third-order edges of an image of any size (too small for the margin: none) whose gradient exceeds `threshold` [grey
/// levels per px]. max_edges is ignored.
ReferenceEdges detect_edges(ImageView image, const EdgesConfig& config, double threshold);

EdgeSet to_edge_set(const ReferenceEdges& edges);

}  // namespace quadedge::reference
