#pragma once
/// \file motion_errors.hpp  Errors of motions: relative to the errors that their covariances predict, and as counts of
/// correct, wrong and lost steps between frames.

#include <cstdint>
#include <vector>

#include "quadedge/config.hpp"
#include "quadedge/evaluation.hpp"
#include "quadedge/odometry.hpp"
#include "quadedge/trajectory.hpp"

namespace quadedge::evaluation {

/// Normalised estimation error squared (NEES) e^T C^-1 e of motions, per degree of freedom. It is 1 if the covariances
/// C describe the errors, and larger if they are too small.
struct Consistency {
  int poses = 0;           ///< motions compared
  double pose = 0;         ///< mean over the motions, for all six degrees of freedom
  double rotation = 0;     ///< for the rotation alone (marginal covariance)
  double translation = 0;  ///< for the translation alone
};

/// Of motions over `frames` frames, composed over the keyframes: errors of the ground truth do not depend on the length
/// of the motion, those of the estimator grow with it.
struct StepConsistency {
  int frames = 0;        ///< length of the motions
  Consistency edges;     ///< with the covariance of the edges alone
  Consistency with_rig;  ///< with the covariance of edges and calibration (`pose.rig_sigma_*`)
  /// Root mean squares of the errors, and of the errors predicted from edges and calibration.
  double error_m = 0, promised_m = 0, error_deg = 0, promised_deg = 0;
};

/// For motions over 1, 2, 5, 10, 20 and 50 frames, and over one, two and five seconds if different; lengths with fewer
/// than kMinSteps motions are omitted. Uses only motions with ground truth at both ends whose frames are connected by
/// measurements.
/// \param config contains the uncertainty of the calibration
std::vector<StepConsistency> judge_steps(const std::vector<FrameResult>& results, const Trajectory& truth,
                                         const PoseConfig& config);
constexpr int kMinSteps = 5;

/// A step is correct if E = truth_step^-1 estimated_step is below both limits.
struct StepLimits {
  double translation_m = 0.05;      ///< limit of |t(E)|
  double translation_ratio = 0.10;  ///< added to it, as a fraction of the true step length
  double rotation_deg = 2;          ///< limit of the angle of R(E)
};

/// Steps between consecutive frames with ground truth.
struct StepJudgement {
  int right = 0;
  int wrong = 0;                              ///< reported as tracked, but beyond a limit
  int lost = 0;                               ///< at least one of the two frames has no pose, or their segments differ
  std::vector<std::int64_t> wrong_stamps_ns;  ///< the later frame of each wrong step
  int steps() const { return right + wrong + lost; }
};

/// Evaluates each step separately; errors do not accumulate. `frames_ns`: timestamps of all frames, increasing; poses
/// are matched with the nearest one within `max_stamp_difference_ns`. Steps without ground truth at both ends are
/// ignored.
StepJudgement judge_steps(const Trajectory& estimate, const Trajectory& truth,
                          const std::vector<std::int64_t>& frames_ns, const StepLimits& limits = {},
                          std::int64_t max_stamp_difference_ns = kStampToleranceNs);

}  // namespace quadedge::evaluation
