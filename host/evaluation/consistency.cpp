#include "evaluation/consistency.hpp"

#include <Eigen/Cholesky>

#include "evaluation/pose_lookup.hpp"

namespace quadedge::evaluation {
namespace {

constexpr std::int64_t kToleranceNs = 10'000'000;

/// (rotation, translation) of the left perturbation that makes `estimate` of `truth`, as FrameResult::covariance has
/// it.
Eigen::Matrix<double, 6, 1> perturbation(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth) {
  const Eigen::Matrix3d turn = estimate.linear() * truth.linear().transpose();
  const Eigen::AngleAxisd rotation(turn);
  Eigen::Matrix<double, 6, 1> error;
  error << rotation.angle() * rotation.axis(), estimate.translation() - turn * truth.translation();
  return error;
}

}  // namespace

Consistency judge_covariances(const std::vector<FrameResult>& results, const Trajectory& truth) {
  Consistency sums;
  for (const auto& result : results) {
    if (result.status != FrameStatus::tracked || !(result.covariance.diagonal().minCoeff() > 0)) continue;
    const auto& reference = results.at(static_cast<std::size_t>(result.reference_frame));
    const auto* true_reference = pose_at(truth, reference.stamp_ns, kToleranceNs);
    const auto* true_current = pose_at(truth, result.stamp_ns, kToleranceNs);
    if (true_reference == nullptr || true_current == nullptr) continue;
    const auto error = perturbation(result.current_from_reference, true_current->inverse() * *true_reference);
    const Eigen::Matrix3d turning = result.covariance.topLeftCorner<3, 3>(),
                          moving = result.covariance.bottomRightCorner<3, 3>();
    ++sums.poses;
    sums.pose += error.dot(result.covariance.ldlt().solve(error)) / 6;
    sums.rotation += error.head<3>().dot(turning.ldlt().solve(error.head<3>())) / 3;
    sums.translation += error.tail<3>().dot(moving.ldlt().solve(error.tail<3>())) / 3;
  }
  if (sums.poses == 0) return {};
  return {sums.poses, sums.pose / sums.poses, sums.rotation / sums.poses, sums.translation / sums.poses};
}

}  // namespace quadedge::evaluation
