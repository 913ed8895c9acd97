/// \file motion_errors.cpp  Chains covariances to a common keyframe and normalises errors by them (NEES).
#include "output/motion_errors.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "common/numeric.hpp"
#include "data/trajectory_rows.hpp"
#include "geometry/uncertain_pose.hpp"

namespace quadedge::evaluation {
namespace {

/// The chain of references of a frame: the frame itself, its keyframe, the keyframe of that frame ... up to the first.
std::vector<int> references(const std::vector<FrameResult>& results, int frame) {
  std::vector<int> chain{frame};
  while (results[static_cast<std::size_t>(chain.back())].diagnostics.covariance_in_reference &&
         results[static_cast<std::size_t>(chain.back())].status == FrameStatus::tracked)
    chain.push_back(results[static_cast<std::size_t>(chain.back())].reference_frame);
  return chain;
}

/// Pose of the first frame of `chain` in the frame of its member number `length`.
pose::UncertainPose pose_along(const std::vector<FrameResult>& results, const std::vector<int>& chain,
                               std::size_t length) {
  pose::UncertainPose result;
  for (std::size_t k = length; k-- > 0;) {
    const FrameResult& link = results[static_cast<std::size_t>(chain[k])];
    pose::UncertainPose step =
        pose::pose_in_earlier({*link.current_from_reference, pose::in_other_order(*link.relative_covariance)});
    step.by_rig = link.diagnostics.rig_sensitivity;
    result = result * step;
  }
  return result;
}

/// earlier_from_later; nothing if no measurements connect the frames.
std::optional<pose::UncertainPose> motion_between(const std::vector<FrameResult>& results, int earlier, int later) {
  const auto a = references(results, earlier), b = references(results, later);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto common = std::find(b.begin(), b.end(), a[i]);
    if (common == b.end()) continue;
    return inverse(pose_along(results, a, i)) * pose_along(results, b, static_cast<std::size_t>(common - b.begin()));
  }
  return std::nullopt;
}

double normalised(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  return error.dot(covariance.ldlt().solve(error)) / static_cast<double>(error.size());
}

/// Adds an error to the sums over motions.
void add(const Eigen::Matrix<double, 6, 1>& error, const PoseCovariance& covariance, Consistency& sums) {
  ++sums.poses;
  sums.pose += normalised(error, covariance);
  sums.translation += normalised(error.head<3>(), covariance.topLeftCorner<3, 3>());
  sums.rotation += normalised(error.tail<3>(), covariance.bottomRightCorner<3, 3>());
}

Consistency mean(const Consistency& sums) {
  if (sums.poses == 0) return {};
  return {sums.poses, sums.pose / sums.poses, sums.rotation / sums.poses, sums.translation / sums.poses};
}

/// Evaluates the motions from every frame to the frame `frames` later.
StepConsistency judge_length(const std::vector<FrameResult>& results, const Trajectory& truth, const PoseConfig& config,
                             int frames) {
  StepConsistency step;
  step.frames = frames;
  Eigen::Matrix<double, 4, 1> squares = Eigen::Matrix<double, 4, 1>::Zero();
  for (int first = 0; first + frames < static_cast<int>(results.size()); ++first) {
    const auto& from = results[static_cast<std::size_t>(first)];
    const auto& to = results[static_cast<std::size_t>(first + frames)];
    const auto* true_from = data::pose_at(truth, from.stamp_ns, kStampToleranceNs);
    const auto* true_to = data::pose_at(truth, to.stamp_ns, kStampToleranceNs);
    if (true_from == nullptr || true_to == nullptr || !is_tracked(from.status) || !is_tracked(to.status)) continue;
    const auto motion = motion_between(results, first, first + frames);
    if (!motion || !(motion->covariance.diagonal().minCoeff() > 0)) continue;
    const Eigen::Isometry3d true_motion = true_from->world_from_left.inverse() * true_to->world_from_left;
    const Eigen::AngleAxisd turn(motion->fixed_from_camera.linear() * true_motion.linear().transpose());
    Eigen::Matrix<double, 6, 1> error;
    error << motion->fixed_from_camera.translation() - true_motion.translation(), turn.angle() * turn.axis();
    const PoseCovariance whole = pose::whole_covariance(*motion, config);
    add(error, motion->covariance, step.edges);
    add(error, whole, step.with_rig);
    squares += Eigen::Vector4d(error.head<3>().squaredNorm(), whole.topLeftCorner<3, 3>().trace(),
                               error.tail<3>().squaredNorm(), whole.bottomRightCorner<3, 3>().trace());
  }
  if (step.edges.poses > 0) squares /= step.edges.poses;
  step.error_m = std::sqrt(squares(0));
  step.promised_m = std::sqrt(squares(1));
  step.error_deg = std::sqrt(squares(2)) / kDegree;
  step.promised_deg = std::sqrt(squares(3)) / kDegree;
  step.edges = mean(step.edges);
  step.with_rig = mean(step.with_rig);
  return step;
}

}  // namespace

std::vector<StepConsistency> judge_steps(const std::vector<FrameResult>& results, const Trajectory& truth,
                                         const PoseConfig& config) {
  std::set<int> lengths{1, 2, 5, 10, 20, 50};
  if (results.size() > 1) {
    const double seconds = 1e-9 * static_cast<double>(results.back().stamp_ns - results.front().stamp_ns) /
                           static_cast<double>(results.size() - 1);
    for (const double length : {1.0, 2.0, 5.0})
      if (seconds > 0 && length / seconds < static_cast<double>(results.size()))
        lengths.insert(std::max(1, static_cast<int>(std::lround(length / seconds))));
  }
  std::vector<StepConsistency> steps;
  for (const int length : lengths) {
    auto step = judge_length(results, truth, config, length);
    if (step.edges.poses >= kMinSteps) steps.push_back(step);
  }
  return steps;
}

StepJudgement judge_steps(const Trajectory& estimate, const Trajectory& truth,
                          const std::vector<std::int64_t>& frames_ns, const StepLimits& limits,
                          std::int64_t max_stamp_difference_ns) {
  StepJudgement result;
  for (std::size_t i = 1; i < frames_ns.size(); ++i) {
    const auto* true_before = data::pose_at(truth, frames_ns[i - 1], max_stamp_difference_ns);
    const auto* true_after = data::pose_at(truth, frames_ns[i], max_stamp_difference_ns);
    if (true_before == nullptr || true_after == nullptr) continue;
    const auto* before = data::pose_at(estimate, frames_ns[i - 1], max_stamp_difference_ns);
    const auto* after = data::pose_at(estimate, frames_ns[i], max_stamp_difference_ns);
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
