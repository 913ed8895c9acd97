#pragma once
/// \file motion_search.hpp  From the current stereo edges to the motion since an earlier rig: where to look, and what to believe.

#include <Eigen/Geometry>
#include <optional>

#include "odometry/disparity_offset.hpp"
#include "pose/motion.hpp"
#include "quadedge/config.hpp"
#include "stages/frontend.hpp"

namespace quadedge::odometry {

/// Quads between a base and the current frame, and the motion they agree on.
struct MotionStep {
  stages::Base base = stages::Base::previous;
  TemporalMatches matches;
  pose::QuadObservations quads;
  pose::MotionEstimate motion;
};

/// What is known of the current frame's motion before its edges are matched with earlier ones.
struct MotionPrior {
  std::optional<Eigen::Isometry3d> prediction;  ///< current_from_previous by constant velocity
  Eigen::Isometry3d previous_from_key = Eigen::Isometry3d::Identity();
  bool previous_is_key = false;
  std::uint64_t seed = 0;
};

/// A scout finds the motion since the previous rig, in growing circles; it guides the matching with the key rig or, where that one is
/// out of sight, with the previous rig, and that matching has to convince.
class MotionSearch {
 public:
  /// Refers to the frontend and to the offset, which must outlive it.
  MotionSearch(const StereoRig& rig, const Config& config, stages::Frontend& frontend, const DisparityOffset& offset)
      : rig_(rig), config_(config), frontend_(frontend), offset_(offset) {}

  /// The motion of the frontend's current rig; its status says whether there is one.
  MotionStep find(const MotionPrior& prior) const;

 private:
  MotionStep scout(const MotionPrior& prior, double radius) const;
  MotionStep match(stages::Base base, Eigen::Isometry3d prediction, std::uint64_t seed) const;
  MotionStep estimate(stages::Base base, const stages::TemporalSearch& search, const std::optional<Eigen::Isometry3d>& prediction,
                      const PoseConfig& limits, std::uint64_t seed) const;

  StereoRig rig_;
  Config config_;
  stages::Frontend& frontend_;
  const DisparityOffset& offset_;
};

}  // namespace quadedge::odometry
