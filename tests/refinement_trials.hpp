#pragma once
/// \file refinement_trials.hpp  Refined poses of generated drives and their errors.

#include "generated_quads.hpp"
#include "motion/refinement.hpp"

namespace generated {

using quadedge::pose::RefinementWorkspace;
using quadedge::pose::Vector6d;

/// Result of a refinement that has a solution.
inline quadedge::pose::MotionEstimate refined_by(const QuadObservations& quads, const quadedge::StereoRig& rig,
                                                 const quadedge::PoseConfig& config, const Eigen::Isometry3d& initial,
                                                 double offset_variance = 0) {
  RefinementWorkspace workspace;
  quadedge::pose::MotionEstimate refined;
  refined.current_from_previous = initial;
  REQUIRE(refine(quads, rig, config, offset_variance, workspace, refined));
  return refined;
}

/// Left perturbation that takes the truth to the estimate.
inline Vector6d error_of(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth) {
  const Eigen::AngleAxisd turn(estimate.linear() * truth.linear().transpose());
  Vector6d error;
  error << turn.angle() * turn.axis(), estimate.translation() - turn * truth.translation();
  return error;
}

/// Errors of many refined poses.
struct Trials {
  Vector6d mean = Vector6d::Zero(), standard_error = Vector6d::Zero();
  double nees = 0;  ///< normalised estimation error squared, mean per degree of freedom
};

inline Trials run_trials(const Problem& problem, int trials) {
  quadedge::PoseConfig config;
  Trials result;
  Vector6d squares = Vector6d::Zero();
  for (int trial = 0; trial < trials; ++trial) {
    const auto g = generate(problem, 1000 + static_cast<std::uint64_t>(trial));
    const auto refined = refined_by(g.quads, problem.rig, config, problem.motion);
    const Vector6d error = error_of(refined.current_from_previous, problem.motion);
    result.mean += error / trials;
    squares += error.cwiseAbs2() / trials;
    result.nees += error.dot(refined.learned.covariance.ldlt().solve(error)) / (6.0 * trials);
  }
  result.standard_error = ((squares - result.mean.cwiseAbs2()) / trials).cwiseSqrt();
  return result;
}

}  // namespace generated
