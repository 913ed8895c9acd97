#pragma once
/// \file pools.hpp  Determines which edges have a counterpart.

#include <algorithm>
#include <cmath>
#include <vector>

#include "evaluation/filter_table.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"
#include "reference/point_index.hpp"

namespace quadedge::evaluation {

/// Finds the edges of an image near a position.
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

/// Angle between two directions modulo a half turn [deg].
double line_angle_deg(double a, double b);

/// Pools of stereo matching. Edges with an angle below `min_epipolar_angle` [deg] to their epipolar line belong to
/// neither pool, because they are not matched. An edge is paired if it is visible and a right edge lies within the
/// tolerances of its true position, its epipolar line and its direction.
Pools stereo_pools(const StereoRig& rig, const EdgeSet& left, const EdgeSet& right, const TruePositions& truth,
                   double min_epipolar_angle, const MatchingTolerance& tolerance);

/// Pools of temporal matching within one image. An edge is paired if it is visible, its stereo edge is veridical, and a
/// current stereo edge lies within the tolerances of its true position and its previous direction.
/// \param previous_is_veridical one entry per previous stereo edge
Pools temporal_pools(const std::vector<float>& previous_direction,
                     const std::vector<std::uint8_t>& previous_is_veridical, const EdgePositionsView& current,
                     int image_height, const TruePositions& truth, const MatchingTolerance& tolerance);

/// Pools of quads: an edge is paired if ONE current stereo edge is the counterpart in both images.
Pools quad_pools(const StereoEdges& previous, const std::vector<std::uint8_t>& previous_is_veridical,
                 const StereoEdges& current, int image_height, const TruePositions& left_truth,
                 const TruePositions& right_truth, const MatchingTolerance& tolerance);

}  // namespace quadedge::evaluation
