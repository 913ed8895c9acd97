#include "pose/offset_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "pose/pose_constants.hpp"

namespace quadedge::pose {

bool fit_offset(const PoseConfig& config, const MeasuredCovariance& covariance, double variance,
                double reprojection_scale, ReprojectionTerms& terms, OffsetFit& result) {
  using Matrix7d = Eigen::Matrix<double, 7, 7>;
  using Vector7d = Eigen::Matrix<double, 7, 1>;
  const double weight = std::max(covariance.small_cell_inflation, 1.0);
  Eigen::Isometry3d pose = result.current_from_previous;
  double offset = result.offset;
  for (int iteration = 0; iteration < kFitSteps; ++iteration) {
    Normal<7> normal = normal_by_pose_and_offset(terms, pose, offset, {reprojection_scale, config.student_dof});
    normal.matrix /= weight;
    normal.gradient /= weight;
    Matrix7d spread = normal.matrix * (std::max(covariance.inflation, 1.0) / weight);  // of the gradient
    normal.matrix(6, 6) += 1.0 / variance;
    spread(6, 6) += 1.0 / variance;
    normal.gradient(6) += offset / variance;
    Vector7d step;
    if (!solve(normal, step)) return false;
    pose = perturb(step.head<6>(), pose);
    offset += step(6);
    const Matrix7d inverse = normal.matrix.ldlt().solve(Matrix7d::Identity());
    result.covariance = inverse * spread * inverse;
    result.offset_variance = inverse(6, 6);
    if (-normal.gradient.dot(step) < kFitTolerance * kFitTolerance) break;
  }
  result.covariance = (0.5 * (result.covariance + result.covariance.transpose())).eval();
  result.current_from_previous = pose;
  result.offset = offset;
  return true;
}

}  // namespace quadedge::pose
