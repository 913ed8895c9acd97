#pragma once
/// \file surface_map.hpp  Ground truth of one view: how near the scene is at every pixel, and what an edge there
/// belongs to.

#include <optional>
#include <vector>

#include "data/float_map.hpp"
#include "quadedge/image.hpp"

namespace quadedge::evaluation {

/// height x width, row-major. Nearness is the disparity, or focal length x baseline / depth [px]; NaN is unknown. It is
/// the right quantity to interpolate: along any plane it is a linear function of the pixel, which depth is not.
struct SurfaceMap {
  int width = 0, height = 0;
  std::vector<float> nearness;
  bool empty() const { return nearness.empty(); }
  /// Value at the pixel nearest to a position, NaN outside.
  float nearest(double x, double y) const;
};

/// Disparities in `scale` px per unit; infinite, NaN, zero and negative ones are unknown.
SurfaceMap surface_from_disparity(const data::FloatMap& disparity, double scale);
/// Grey-coded disparities, `scale` px per grey level; 0 is unknown.
SurfaceMap surface_from_grey(const Image& disparity, double scale);
/// Depths z [m]; 0 is unknown.
SurfaceMap surface_from_depth(const data::FloatMap& depth, double focal_times_baseline);

/// More than this between neighbouring pixels is a depth step, less is one surface [px of nearness].
inline constexpr double kDepthStep = 1.0;
/// An edge this near to a depth step, measured across the edge, is the occluding contour itself [px]: half a pixel of
/// the map's rounding plus the displacement by the detector's blur and by an imprecise truth. Measured: of the matched
/// edges within 1.5 px of a step 80 to 99 % move with the nearer surface (rendered room and cables, Middlebury),
/// whichever side they lie on.
inline constexpr double kContourReach = 1.5;
/// On the farther side, up to this distance, either surface may own an edge [px] (texture of the farther one, or a
/// contour moved outwards by blur and shading): between the two reaches about half of the matched edges move with each.
inline constexpr double kDoubtReach = 2.5;

/// What an edge belongs to.
struct SurfacePoint {
  double nearness = 0;   ///< px, sub-pixel
  bool contour = false;  ///< the edge lies on a depth step; `nearness` is that of the nearer surface
};

/// The surface that an edge belongs to. The map is read at the pixels met within kContourReach to either side along the
/// edge's normal.
/// - Any of them unknown: no statement (an unseen nearer surface could own the edge).
/// - They differ by more than kDepthStep: the edge is an occluding contour and belongs to the nearer surface, whose
/// values
///   within kDepthStep of the nearest one are weighted by their closeness to the edge's position and averaged.
/// - A nearer surface begins between kContourReach and kDoubtReach to either side: no statement.
/// - Else bilinear interpolation, over those of the four pixels around the position that lie within kDepthStep of the
/// nearest
///   pixel: a step that the edge ends at (along its direction) does not smear into it.
/// \param direction of the tangent [rad]
std::optional<SurfacePoint> surface_at(const SurfaceMap& map, double x, double y, double direction);

/// Whether another view shows a point.
enum class Visibility { unknown, visible, occluded };

/// Compares a point's nearness with the map of a view in which it falls on (x, y). Visible: one of the pixels
/// within 1.5 px shows that nearness to within kDepthStep. Occluded: all known ones are nearer, or the position is
/// outside the image. Unknown: none is known, or the view shows something farther there, which contradicts the point.
Visibility visibility(const SurfaceMap& map, double x, double y, double nearness);

/// The right view's map as far as the left one tells it (rectified pairs): every known pixel moved by its disparity,
/// gaps between neighbours on one surface filled, the nearest surface wins.
SurfaceMap right_from_left(const SurfaceMap& left, int right_width);

}  // namespace quadedge::evaluation
