#include "pose/offset_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "pose/pose_constants.hpp"

namespace quadedge::pose {

namespace {

using Matrix7d = Eigen::Matrix<double, 7, 7>;
using Vector7d = Eigen::Matrix<double, 7, 1>;

/// What the quads alone say about the pose and the offset. The pose is eliminated: it follows the offset along the line
/// that the quads leave open.
struct Elimination {
  explicit Elimination(const Matrix7d& information)
      : pose_given_offset(information.topLeftCorner<6, 6>().ldlt().solve(Matrix6d::Identity())),
        pose_by_offset(-pose_given_offset * information.col(6).head<6>()),
        offset(std::max(0.0, information(6, 6) + information.row(6).head<6>().dot(pose_by_offset))) {}

  Matrix6d pose_given_offset;  ///< covariance [rad, m]
  Vector6d pose_by_offset;     ///< derivative [rad/px, m/px]
  double offset;               ///< information about the offset with the pose unknown [1/px^2]
};

/// Variance of the offset due to systematic errors, in units of that due to independent errors. Systematic errors may
/// look like an offset, so that their weights add up as if the pose were known: those of disparities with the
/// information about the offset, those of positions with that about a common shift of the image.
double systematic_ratio(const Matrix7d& information, double focal_length) {
  const double shift = 0.5 * (information(0, 0) + information(1, 1)) / (focal_length * focal_length);
  return kSystematicDisparity * kSystematicDisparity * information(6, 6) +
         kSystematicPosition * kSystematicPosition * shift;
}

/// \param free solution of the equations with a prior of `variance` \param spread see fit_offset()
PoseAndOffset learned_from(const FreeFit& free, const Matrix7d& information, double variance, double spread,
                           double focal_length) {
  const Elimination quads(information);
  const double systematic = systematic_ratio(information, focal_length);
  const double known = variance * quads.offset;
  const double gain = known / (1 + systematic + known);
  const double by_prior = (1 - gain) * (1 - gain) * variance;
  const double by_quads = quads.offset > 0 ? gain * gain / quads.offset : 0;
  PoseAndOffset learned;
  learned.offset = free.offset * (1 + known) / (1 + systematic + known);
  learned.current_from_previous =
      perturb(quads.pose_by_offset * (learned.offset - free.offset), free.current_from_previous);
  learned.offset_variance = by_prior + by_quads * (1 + systematic);
  learned.covariance = spread * quads.pose_given_offset + (by_prior + by_quads * (spread + systematic)) *
                                                              quads.pose_by_offset * quads.pose_by_offset.transpose();
  return learned;
}

}  // namespace

bool fit_offset(const PoseConfig& config, const MeasuredCovariance& covariance, double variance,
                double reprojection_scale, double focal_length, ReprojectionTerms& terms, OffsetFit& result) {
  const double weight = std::max(covariance.small_cell_inflation, 1.0);
  const double spread = std::max(covariance.inflation, 1.0) / weight;
  FreeFit& free = result.free;
  Normal<7> normal;
  for (int iteration = 0; iteration < kFitSteps; ++iteration) {
    normal = normal_by_pose_and_offset(terms, free.current_from_previous, free.offset,
                                       {reprojection_scale, config.student_dof});
    normal.matrix /= weight;
    normal.gradient /= weight;
    normal.matrix(6, 6) += 1.0 / variance;
    normal.gradient(6) += free.offset / variance;
    Vector7d step;
    if (!solve(normal, step)) return false;
    free.current_from_previous = perturb(step.head<6>(), free.current_from_previous);
    free.offset += step(6);
    if (-normal.gradient.dot(step) < kFitTolerance * kFitTolerance) break;
  }
  normal.matrix(6, 6) -= 1.0 / variance;
  result.learned = learned_from(free, normal.matrix, variance, spread, focal_length);
  return true;
}

}  // namespace quadedge::pose
