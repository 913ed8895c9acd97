#pragma once
/// \file pools.hpp  Which edges have a counterpart at all.

#include <algorithm>
#include <cmath>
#include <vector>

#include "evaluation/filter_table.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"
#include "reference/point_index.hpp"

namespace quadedge::evaluation {

/// Edges of an image that can be asked for those near a position.
class NearbyTargets {
 public:
  /// The arrays must outlive the object. `height`: of the image [px].
  NearbyTargets(const std::vector<float>& x, const std::vector<float>& y, int height) : x_(x), y_(y) {
    const float right_end = x.empty() ? 0 : *std::max_element(x.begin(), x.end());
    reference::make_point_index(x, y, std::max(1, static_cast<int>(std::ceil(right_end)) + 1), height, index_);
  }

  /// Calls `found(index)` for every target within `radius` px of the position.
  template <class Found>
  void visit(double x, double y, double radius, const Found& found) const {
    constexpr float kRounding = 0.01F;
    index_.visit_square(static_cast<float>(x), static_cast<float>(y), static_cast<float>(radius) + kRounding,
                        [&](std::int32_t number) {
                          const auto j = static_cast<std::size_t>(number);
                          if (std::hypot(x_[j] - x, y_[j] - y) <= radius) found(j);
                        });
  }

 private:
  const std::vector<float>& x_;
  const std::vector<float>& y_;
  reference::PointIndex index_;
};

/// Angle between two directions modulo half a turn [deg].
double line_angle_deg(double a, double b);

/// Pools of stereo matching. Edges nearer than `min_epipolar_angle` [deg] to their epipolar line belong to neither:
/// they take no part in stereo. An edge is paired when it is visible and a right edge lies within the tolerance of its
/// true position, of its epipolar line, and of its own direction.
Pools stereo_pools(const StereoRig& rig, const EdgeSet& left, const EdgeSet& right, const TruePositions& truth,
                   double min_epipolar_angle, const MatchingTolerance& tolerance);

/// Pools of matching in time within one image. An edge is paired when it is visible, its own stereo edge is veridical,
/// and a current stereo edge lies within the tolerance of its true position and of its previous direction. \param
/// previous_is_veridical one entry per previous stereo edge
Pools temporal_pools(const std::vector<float>& previous_direction,
                     const std::vector<std::uint8_t>& previous_is_veridical, const EdgePositionsView& current,
                     int image_height, const TruePositions& truth, const MatchingTolerance& tolerance);

/// Pools of quads: paired when ONE current stereo edge is the counterpart in both images.
Pools quad_pools(const StereoEdges& previous, const std::vector<std::uint8_t>& previous_is_veridical,
                 const StereoEdges& current, int image_height, const TruePositions& left_truth,
                 const TruePositions& right_truth, const MatchingTolerance& tolerance);

}  // namespace quadedge::evaluation
