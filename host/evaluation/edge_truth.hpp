#pragma once
/// \file edge_truth.hpp  True positions of edges in another view, from ground truth.

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
  /// Whether the right map was measured; if not, it is predicted from the left map (right_from_left()).
  bool right_is_measured = false;
  /// Left pixels that the dataset marks as occluded in the right view; empty if there is no such mask.
  std::vector<std::uint8_t> occluded;
  /// Depth [m] = depth_scale / nearness. 0 for pairs with disparities, whose true position is x - disparity in the same
  /// row.
  double depth_scale = 0;
  /// Pose of the left camera; nothing for single pairs.
  std::optional<Eigen::Isometry3d> world_from_left;
};

/// One entry per edge: its position in the other view [px] and its visibility there. Occluded edges also have a
/// position.
struct TruePositions {
  std::vector<float> x, y;
  std::vector<Visibility> state;      ///< unknown: no ground truth for this edge
  std::vector<std::uint8_t> contour;  ///< whether the edge lies on a depth step of its own view

  void reserve(std::size_t size);
  void push(double at_x, double at_y, Visibility visible, bool on_contour);
};

/// True positions of left edges in the right image of the same frame.
TruePositions true_right_positions(const StereoRig& rig, const FrameTruth& truth, const EdgePositionsView& left_edges);

/// True positions of the left edges of `before` in one image of `now`; requires poses and depths of both frames.
TruePositions true_later_positions(const StereoRig& rig, const FrameTruth& before, const FrameTruth& now, Side side,
                                   const EdgePositionsView& left_edges);

}  // namespace quadedge::evaluation
