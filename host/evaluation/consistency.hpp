#pragma once
/// \file consistency.hpp  Are the covariances consistent? Errors of the poses against what the estimator says of their
/// size.

#include <vector>

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

}  // namespace quadedge::evaluation
