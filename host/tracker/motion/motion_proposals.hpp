#pragma once
/// \file motion_proposals.hpp  The hypotheses about the motion of a frame, each from a subset of the edges.

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "edges/frontend.hpp"
#include "geometry/corrected_rig.hpp"
#include "motion/motion.hpp"
#include "motion/motion_step.hpp"
#include "motion/quads.hpp"
#include "quadedge/config.hpp"

namespace quadedge::odometry {

/// Creates motion steps and estimates the motion that their matches support. It must outlive the steps.
class MotionFits {
 public:
  /// \param rig the calibration
  MotionFits(const Config& config, const StereoRig& rig) : config_(config), rig_(corrected_rig(rig, {})) {}

  /// Returns a step from `base` without matches.
  StepHandle new_step(const MotionQuery& query, const frontend::FrameEdgesHandle& base);

  /// Estimates the motion of the step's matches; covariance and offset only for RefinementGoal::pose_and_covariance,
  /// which a confirmed motion needs. \param initial a hypothesis besides the samples, current_from_base
  void fit(const MotionQuery& query, const PoseConfig& limits, const std::optional<Eigen::Isometry3d>& initial,
           pose::RefinementGoal goal, MotionStep& step);
  /// Time spent in fit() since the last call [ms].
  double take_pose_ms() { return std::exchange(pose_ms_, 0); }

  /// The edges of a frame, measured with its rig: that of the query with its own displacement.
  const pose::MeasuredEdges& measured(const frontend::FrameEdges& frame_edges, const MotionQuery& query) const;
  /// The corrected geometry of the current frame.
  StereoRig calibration(const MotionQuery& query) const { return corrected_rig(rig_, query.rig); }

 private:
  Config config_;
  StereoRig rig_;  ///< as calibrated, without undistortion tables
  Pool<MotionStep> steps_;
  pose::QuadBuilder quad_builder_;
  std::vector<pose::StereoMeasurement> previous_, current_;  ///< of the step that is fitted: 350 bytes per quad
  pose::MotionEstimator estimator_;
  double pose_ms_ = 0;
};

/// Relaxed limits for the motion of a subset of the edges, to be confirmed by a guided search.
PoseConfig limits_of_proposals(const Config& config);

/// Each function returns a motion since the query's base, or null if there is nothing to try.
class MotionProposals {
 public:
  /// Refers to the front end and the fits, which must outlive the object.
  MotionProposals(const Config& config, frontend::Frontend& frontend, MotionFits& fits);

  /// The camera moves as predicted: every n-th edge is searched for around the predicted position.
  StepHandle near_prediction(const MotionQuery& query);
  /// The same within a large radius, around the previous positions if there is no prediction.
  StepHandle in_large_radius(const MotionQuery& query);
  /// The camera is stationary, and only objects in front of it move.
  StepHandle still_camera(const MotionQuery& query);
  /// The motion of a part of the global matches; null unless most of them agree, in many parts of the image.
  StepHandle few_global_matches(const MotionQuery& query);
  /// The camera may have moved arbitrarily: a subset of the edges is matched over the whole image, first a small one,
  /// which suffices where most of its matches agree.
  StepHandle global_matches(const MotionQuery& query);
  /// The motion of the global matches is that of an object: those that it does not explain have another one.
  StepHandle rest_of_global_matches(const MotionQuery& query, const MotionStep& global_matches);
  /// The confirmed motion is that of an object, and the scene moves differently by a few pixels: the quads that do not
  /// agree closely have another motion. Both lie within the inlier distance of a compromise between them.
  StepHandle rest_of_confirmed(const MotionQuery& query, const MotionStep& confirmed);
  /// The motion of the global matches in the image cells that the chosen motion does not explain; the base's edges
  /// count where it predicts them.
  StepHandle in_free_cells(const MotionQuery& query, const MotionStep& chosen);

 private:
  StepHandle in_radius(const MotionQuery& query, double radius);
  StepHandle matched_globally(const MotionQuery& query, int edges);
  /// A step with those matches of `other` for which `is_rest` is not 0.
  StepHandle with_rest_of(const MotionQuery& query, const MotionStep& other, const PoseConfig& limits);

  Config config_;
  PoseConfig limits_, global_limits_;
  frontend::Frontend& frontend_;
  MotionFits& fits_;
  TemporalSearch search_;  ///< kept between calls, as are the next
  GlobalSearch among_;
  std::vector<std::uint8_t> is_rest_;  ///< one per match
};

}  // namespace quadedge::odometry
