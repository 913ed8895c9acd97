#pragma once
/// \file step_judgement.hpp  Counts the steps between frames that are right, wrong and lost: what matters where frames
/// lie far apart.

#include <cstdint>
#include <vector>

#include "quadedge/trajectory.hpp"

namespace quadedge::evaluation {

/// A step is right while E = truth_step^-1 estimated_step stays below both limits.
struct StepLimits {
  double translation_m = 0.05;      ///< |t(E)| at most this much,
  double translation_ratio = 0.10;  ///< plus this part of the true step's length
  double rotation_deg = 2;          ///< angle of R(E)
};

/// Steps between consecutive frames that have ground truth.
struct StepJudgement {
  int right = 0;
  int wrong = 0;                              ///< reported as tracked, and beyond a limit
  int lost = 0;                               ///< one of both frames has no pose: what was not solved said so
  std::vector<std::int64_t> wrong_stamps_ns;  ///< the later frame of every wrong step
  int steps() const { return right + wrong + lost; }
};

/// Judges each step by itself; errors do not add up. `frames_ns`: stamps of all frames, increasing; poses belong to the
/// nearest one within `max_stamp_difference_ns`. Steps of which the truth does not know both ends are left out.
StepJudgement judge_steps(const Trajectory& estimate, const Trajectory& truth,
                          const std::vector<std::int64_t>& frames_ns, const StepLimits& limits = {},
                          std::int64_t max_stamp_difference_ns = 10'000'000);

}  // namespace quadedge::evaluation
