#pragma once
/// \file tap_lists.hpp  The clusters that a tap receives after the filters of stereo matching.

#include "common/candidate_lists.hpp"
#include "geometry/epipolar_geometry.hpp"

namespace quadedge::frontend {

/// Larger than any difference of directions [rad].
constexpr float kAnyDirection = 4.0f;

/// The clusters of left edges, at their places on the epipolar lines, for which `passes(edge, cluster)` holds.
template <class Passes>
CandidateLists clusters_that(const StereoClusters& clusters, const EpipolarGeometry& geometry,
                             const std::vector<float>& x, const std::vector<float>& y, const Passes& passes) {
  CandidateLists lists;
  lists.first.assign(1, 0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const EpipolarLine line = epipolar_line(geometry, x[i], y[i]);
    for (auto k = static_cast<std::size_t>(clusters.first[i]); k < static_cast<std::size_t>(clusters.first[i + 1]);
         ++k) {
      if (!passes(i, k)) continue;
      const auto position = static_cast<float>(clusters.position[k]);
      lists.target.push_back(clusters.anchor[k]);
      lists.x.push_back(line.x + position * line.ex);
      lists.y.push_back(line.y + position * line.ey);
      lists.cue.push_back(static_cast<float>(clusters.similarity[k]));
    }
    lists.first.push_back(static_cast<std::int32_t>(lists.target.size()));
  }
  return lists;
}

}  // namespace quadedge::frontend
