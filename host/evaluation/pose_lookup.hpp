#pragma once
/// \file pose_lookup.hpp  Looks up the pose of a trajectory at a time.

#include <algorithm>
#include <cstdlib>

#include "quadedge/trajectory.hpp"

namespace quadedge::evaluation {

/// The pose nearest in time, among poses with increasing timestamps; null if none is within the tolerance.
inline const StampedPose* pose_at(const Trajectory& poses, std::int64_t stamp_ns, std::int64_t tolerance_ns) {
  const auto later =
      std::lower_bound(poses.begin(), poses.end(), stamp_ns,
                       [](const StampedPose& pose, std::int64_t stamp) { return pose.stamp_ns < stamp; });
  const auto distance = [&](Trajectory::const_iterator pose) { return std::abs(pose->stamp_ns - stamp_ns); };
  auto nearest = later;
  if (later != poses.begin() && (later == poses.end() || distance(std::prev(later)) < distance(later)))
    nearest = std::prev(later);
  return nearest != poses.end() && distance(nearest) <= tolerance_ns ? &*nearest : nullptr;
}

}  // namespace quadedge::evaluation
