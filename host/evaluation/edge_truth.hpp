#pragma once
/// \file edge_truth.hpp  Ground truth of a frame's views, and the true positions of edges in another view.

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "data/float_map.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"

namespace quadedge::evaluation {

/// height x width, row-major. Nearness is the disparity, or focal length x baseline / depth [px]; NaN is unknown.
/// Unlike depth, it is linear in the pixel coordinates along any plane and can therefore be interpolated.
struct SurfaceMap {
  int width = 0, height = 0;
  std::vector<float> nearness;
  bool empty() const { return nearness.empty(); }
  /// Value at the pixel nearest to a position; NaN outside the image.
  float nearest(double x, double y) const;
};

/// From disparities with `scale` px per unit; infinite, NaN, zero and negative values are unknown.
SurfaceMap surface_from_disparity(const data::FloatMap& disparity, double scale);
/// From grey-coded disparities with `scale` px per grey level; 0 is unknown.
SurfaceMap surface_from_grey(const Image& disparity, double scale);
/// From depths z [m]; 0 is unknown.
SurfaceMap surface_from_depth(const data::FloatMap& depth, double focal_times_baseline);

/// Difference between adjacent pixels above which they belong to different surfaces [px of nearness].
inline constexpr double kDepthStep = 1.0;
/// Distance from a depth step, measured across the edge, within which an edge is the occluding contour [px]: half a
/// pixel for the rounding of the map, plus the displacement by the detector's blur and by inaccurate ground truth. Of
/// the matched edges within 1.5 px of a step, on either side, 80 to 99 % move with the nearer surface (rendered room
/// and cables, Middlebury).
inline constexpr double kContourReach = 1.5;
/// On the farther side, up to this distance, the edge may belong to either surface [px] (texture of the farther one, or
/// a contour displaced by blur and shading): between the two distances, about half of the matched edges move with each.
inline constexpr double kUnclearReach = 2.5;

/// Surface point of an edge.
struct SurfacePoint {
  double nearness = 0;   ///< [px], sub-pixel
  bool contour = false;  ///< whether the edge lies on a depth step; `nearness` is then that of the nearer surface
};

/// The surface to which an edge belongs. The map is sampled at the pixels within kContourReach to either side along the
/// edge's normal.
/// - If any of them is unknown: nothing (an invisible nearer surface could own the edge).
/// - If they differ by more than kDepthStep, the edge is an occluding contour and belongs to the nearer surface, whose
/// values within kDepthStep of the nearest one are averaged with weights by their distance from the edge.
/// - If a nearer surface begins between kContourReach and kUnclearReach to either side: nothing.
/// - Otherwise: bilinear interpolation over those of the four pixels around the position that lie within kDepthStep of
/// the nearest pixel, so that a step at the end of the edge has no influence.
/// \param direction of the tangent [rad]
std::optional<SurfacePoint> surface_at(const SurfaceMap& map, double x, double y, double direction);

/// Visibility of a point in another view.
enum class Visibility { unknown, visible, occluded };

/// Compares the nearness of a point with the map of a view in which it projects to (x, y). Visible: a pixel within 1.5
/// px has that nearness to within kDepthStep. Occluded: all known pixels are nearer, or the position is outside the
/// image. Unknown: no pixel is known, or the view shows something farther away, which contradicts the point.
Visibility visibility(const SurfaceMap& map, double x, double y, double nearness);

/// The right view's map as predicted from the left one (rectified pairs): every known pixel is moved by its disparity,
/// gaps between neighbours on one surface are filled, and the nearest surface wins.
SurfaceMap right_from_left(const SurfaceMap& left, int right_width);

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
