#pragma once
/// \file least_squares.hpp  Common parts of robust least squares on SE(3): steps, Student-t weights and their scale.

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "pose/pose_constants.hpp"

namespace quadedge::pose {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr double kReprojectionSize = 3, kDirectionSize = 2;  ///< residuals per block
/// Medians of the chi-squared distribution with 3 and 2 degrees of freedom.
constexpr double kReprojectionMedian = 2.3659738843753377, kDirectionMedian = 1.3862943611198906;

/// Applies exp(rotation) and the translation from the left.
Eigen::Isometry3d perturb(const Vector6d& step, const Eigen::Isometry3d& current_from_previous);

/// Student-t weight of a block of `size` residuals with squared error `error` and variance `scale`.
[[gnu::always_inline]] inline double student_weight(double error, double scale, double size, double dof) {
  return (dof + size) / (dof + error / scale);
}

/// Ratio of measured to assumed variance of blocks of residuals, from the median of the first `count` squared errors.
/// \param values a buffer that is kept between calls
double measured_scale(const std::vector<double>& errors, std::size_t count, double median_of_one,
                      std::vector<double>& values);

/// Normal equations of Gauss-Newton.
template <int Size>
struct Normal {
  Eigen::Matrix<double, Size, Size> matrix = Eigen::Matrix<double, Size, Size>::Zero();
  Eigen::Matrix<double, Size, 1> gradient = Eigen::Matrix<double, Size, 1>::Zero();
};

/// Solves A x = -g; returns false if A is singular.
template <int Size>
bool solve(const Normal<Size>& normal, Eigen::Matrix<double, Size, 1>& step) {
  const Eigen::Matrix<double, Size, 1> diagonal = normal.matrix.diagonal();
  if (!(diagonal.minCoeff() > 0)) return false;
  const Eigen::Matrix<double, Size, 1> scale = diagonal.cwiseSqrt().cwiseInverse();
  const Eigen::Matrix<double, Size, Size> scaled = scale.asDiagonal() * normal.matrix * scale.asDiagonal();
  const Eigen::LDLT<Eigen::Matrix<double, Size, Size>> factors(scaled);
  if (factors.info() != Eigen::Success || !(factors.vectorD().minCoeff() > kSmallestPivot)) return false;
  step = scale.asDiagonal() * factors.solve(-(scale.asDiagonal() * normal.gradient));
  return step.allFinite();
}

}  // namespace quadedge::pose
