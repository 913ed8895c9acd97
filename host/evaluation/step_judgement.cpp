#include "evaluation/step_judgement.hpp"

#include "common/numeric.hpp"
#include "evaluation/pose_lookup.hpp"

namespace quadedge::evaluation {
StepJudgement judge_steps(const Trajectory& estimate, const Trajectory& truth,
                          const std::vector<std::int64_t>& frames_ns, const StepLimits& limits,
                          std::int64_t max_stamp_difference_ns) {
  StepJudgement result;
  for (std::size_t i = 1; i < frames_ns.size(); ++i) {
    const auto* true_before = pose_at(truth, frames_ns[i - 1], max_stamp_difference_ns);
    const auto* true_after = pose_at(truth, frames_ns[i], max_stamp_difference_ns);
    if (true_before == nullptr || true_after == nullptr) continue;
    const auto* before = pose_at(estimate, frames_ns[i - 1], max_stamp_difference_ns);
    const auto* after = pose_at(estimate, frames_ns[i], max_stamp_difference_ns);
    if (before == nullptr || after == nullptr || before->segment != after->segment) {
      ++result.lost;
      continue;
    }
    const Eigen::Isometry3d true_step = true_before->world_from_left.inverse() * true_after->world_from_left;
    const Eigen::Isometry3d step = before->world_from_left.inverse() * after->world_from_left;
    const Eigen::Isometry3d error = true_step.inverse() * step;
    const double degrees = Eigen::AngleAxisd(error.linear()).angle() * kDegreesPerRadian;
    const double allowed = limits.translation_m + limits.translation_ratio * true_step.translation().norm();
    if (error.translation().norm() < allowed && degrees < limits.rotation_deg) {
      ++result.right;
    } else {
      ++result.wrong;
      result.wrong_stamps_ns.push_back(frames_ns[i]);
    }
  }
  return result;
}

}  // namespace quadedge::evaluation
