#pragma once
/// \file consistency.hpp  Are the covariances consistent? Errors of the poses against what the estimator says of their
/// size.

#include <vector>

#include "quadedge/config.hpp"
#include "quadedge/odometry.hpp"
#include "quadedge/trajectory.hpp"

namespace quadedge::evaluation {

/// Normalised estimation error squared (NEES) e^T C^-1 e over the tracked frames, per degree of freedom: 1 where the
/// covariances C of the poses relative to their key stereo rigs tell the errors' size, more where they promise too
/// much.
struct Consistency {
  int poses = 0;           ///< frames compared
  double pose = 0;         ///< mean over the frames, all six degrees of freedom together
  double rotation = 0;     ///< of the three of the rotation alone (marginal covariance)
  double translation = 0;  ///< and of the translation alone
};

/// \param results of all frames, in order; \param truth poses of the left camera, matched by the nearest stamp within
/// 10 ms. Frames without a covariance, and those of which the truth does not know both ends, are left out.
Consistency judge_covariances(const std::vector<FrameResult>& results, const Trajectory& truth);

/// The same of the motions over so many frames, composed over the key stereo rigs: errors of the truth's own stay as
/// they are however long the motion is, the estimator's grow with it.
struct StepConsistency {
  int frames = 0;        ///< length of the motions
  Consistency edges;     ///< by what the edges promise alone
  Consistency with_rig;  ///< by edges and rig together (`pose.rig_sigma_*`)
  /// Root mean squares of the errors, and of what edges and rig promise together.
  double error_m = 0, promised_m = 0, error_deg = 0, promised_deg = 0;
};

/// Over 1, 2, 5, 10, 20 and 50 frames, and over one, two and five seconds where those are others; lengths that fewer
/// than kMinSteps motions have are left out. Only motions of which the truth knows both ends and whose frames hang on
/// one key rig by measurements.
/// \param config tells the rig's uncertainty
std::vector<StepConsistency> judge_steps(const std::vector<FrameResult>& results, const Trajectory& truth,
                                         const PoseConfig& config);
constexpr int kMinSteps = 5;

}  // namespace quadedge::evaluation
