#pragma once
/// \file edge_truth.hpp  Where the ground truth says that an edge is seen in another view.

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "evaluation/surface_map.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/side.hpp"

namespace quadedge::evaluation {

/// Ground truth of one stereo frame.
struct FrameTruth {
  SurfaceMap left, right;
  /// The right map was measured; else it only holds what the left map tells (right_from_left).
  bool right_is_measured = false;
  /// Left pixels that the data set itself marks as occluded in the right view; empty without such a mask.
  std::vector<std::uint8_t> occluded;
  /// Depth [m] = depth_scale / nearness. 0 for pairs with disparities: the true position is then x - disparity in the
  /// same row.
  double depth_scale = 0;
  /// Pose of the left camera; nothing for single pairs.
  std::optional<Eigen::Isometry3d> world_from_left;
};

/// One entry per edge: the position in the other view [px], and whether it can be seen there. An occluded edge has a
/// position too.
struct TruePositions {
  std::vector<float> x, y;
  std::vector<Visibility> state;      ///< unknown: no statement about this edge
  std::vector<std::uint8_t> contour;  ///< the edge lies on a depth step of its own view

  void reserve(std::size_t size);
  void push(double at_x, double at_y, Visibility visible, bool on_contour);
};

/// True positions of left edges in the right image of the same frame.
TruePositions true_right_positions(const StereoRig& rig, const FrameTruth& truth, const EdgePositionsView& left_edges);

/// True positions of the left edges of `before` in one image of `now`; both frames with poses and depths.
TruePositions true_later_positions(const StereoRig& rig, const FrameTruth& before, const FrameTruth& now, Side side,
                                   const EdgePositionsView& left_edges);

}  // namespace quadedge::evaluation
