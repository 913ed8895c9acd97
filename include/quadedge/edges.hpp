#pragma once
/// \file edges.hpp  Host-side structures of arrays: third-order edges, stereo edges and quads.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "quadedge/camera.hpp"

namespace quadedge {

/// Positions [px] and directions [rad] of edges in one image, arrays of equal size; NaN: no position.
struct EdgePositions {
  std::vector<float> x, y, direction;

  std::size_t size() const { return x.size(); }
};

/// A view of EdgePositions that another object owns and that must outlive the view.
struct EdgePositionsView {
  const std::vector<float>& x;
  const std::vector<float>& y;
  const std::vector<float>& direction;

  EdgePositionsView(const std::vector<float>& of_x, const std::vector<float>& of_y,
                    const std::vector<float>& of_direction)
      : x(of_x), y(of_y), direction(of_direction) {}
  EdgePositionsView(const EdgePositions& edges)  // NOLINT: deliberately implicit
      : EdgePositionsView(edges.x, edges.y, edges.direction) {}

  std::size_t size() const { return x.size(); }
};

/// Largest distance between an edge and the pixel whose gradient is the maximum, along x and along y [px]: 0.5 from the
/// parabola plus the largest permitted Newton step.
constexpr float kEdgeRowReach = 0.75F;

/// Third-order edges of one image in scan order of their pixels (row by row, left to right). doc/method.md section 1.
struct EdgeSet {
  std::vector<float> x, y;  ///< [px], the centre of the top-left pixel is (0, 0)
  /// Tangent [rad], in (-pi, pi]: the brightness gradient turned by -90 degrees on screen (vertical edge, bright on the
  /// right: -90 degrees). The bright side lies at (-sin, cos), the dark side at (sin, -cos).
  std::vector<float> direction;
  std::vector<float> strength;  ///< gradient magnitude before the Newton step, grey levels per pixel
  /// Displacement of the edge towards its bright side per unit of log(edges.sigma) [px]. A change of image scale by the
  /// same factor displaces it equally; see doc/method.md section 6.
  std::vector<float> scale_shift;
  /// First edge of each row of pixels: row r contains the edges row_first[r] .. row_first[r + 1] - 1. Size height + 1.
  /// The row is that of the pixel that won the maximum test; y lies within kEdgeRowReach of r.
  std::vector<std::int32_t> row_first;

  EdgePositionsView positions() const { return {x, y, direction}; }
  std::size_t size() const { return x.size(); }
};

/// Mutually best stereo edges, in the scan order of their left edges. doc/method.md section 3.
struct StereoEdges {
  std::vector<std::int32_t> left_index;   ///< index of the left edge
  std::vector<std::int32_t> right_index;  ///< of the right edge refined; neighbours on one left curve may share it
  std::vector<float> left_x, left_y, left_direction;     ///< the detected left edge [px, rad]
  std::vector<float> right_x, right_y, right_direction;  ///< the refined point, on its epipolar line as calibrated
  std::vector<float> left_scale_shift;                   ///< of the left edge, see EdgeSet; empty: unknown
  std::vector<float> ncc;  ///< NCC of the refined pair: the mean of the edges' own patches and the better side

  EdgePositionsView positions(Side side) const {
    if (side == Side::left) return {left_x, left_y, left_direction};
    return {right_x, right_y, right_direction};
  }
  std::size_t size() const { return left_index.size(); }
};

/// Temporal matches between the stereo edges of two rigs: quads that close the circle. doc/method.md section 4.
struct TemporalMatches {
  std::vector<std::int32_t> previous;   ///< index into the previous frame's stereo edges
  std::vector<std::int32_t> current;    ///< index into the current frame's stereo edges
  std::vector<float> left_x, left_y;    ///< detected position in the current left image [px]
  std::vector<float> right_x, right_y;  ///< refined position in the current right image [px]
  /// Directions there [rad], of the clusters that the paper's method forms in time; empty: those of the current edge.
  std::vector<float> left_direction, right_direction;
  std::vector<float> ncc;                        ///< mean of the left and the right NCC
  std::vector<std::int32_t> competing_clusters;  ///< further ones of the previous edge's candidates
  int search = -1;                               ///< number of the temporal search that found them, see Tap; -1: none
  /// Previous stereo edges with at least one candidate in the left / right image in that search, before the agreement.
  int alive_left = 0, alive_right = 0;

  std::size_t size() const { return previous.size(); }
  /// Removes all matches and keeps the memory.
  void clear() {
    for (auto* values : {&previous, &current, &competing_clusters}) values->clear();
    for (auto* values : {&left_x, &left_y, &right_x, &right_y, &left_direction, &right_direction, &ncc})
      values->clear();
    search = -1;
    alive_left = alive_right = 0;
  }
  /// Adds a match with stereo edge `current_edge` of `edges`, at that edge's positions.
  void append(std::int32_t previous_edge, std::int32_t current_edge, const StereoEdges& edges, float similarity,
              std::int32_t competing) {
    const auto j = static_cast<std::size_t>(current_edge);
    previous.push_back(previous_edge);
    current.push_back(current_edge);
    left_x.push_back(edges.left_x[j]);
    left_y.push_back(edges.left_y[j]);
    right_x.push_back(edges.right_x[j]);
    right_y.push_back(edges.right_y[j]);
    ncc.push_back(similarity);
    competing_clusters.push_back(competing);
  }
};

}  // namespace quadedge
