#pragma once
/// \file step_judgement.hpp  Counts correct, wrong and lost steps between frames, for datasets whose frames are far
/// apart.

#include <cstdint>
#include <vector>

#include "quadedge/evaluation.hpp"
#include "quadedge/trajectory.hpp"

namespace quadedge::evaluation {

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
