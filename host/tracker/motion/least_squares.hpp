#pragma once
/// \file least_squares.hpp  Robust least squares on SE(3): steps, Student-t weights and their scale, and the
/// contribution of one quad's reprojection residuals to the normal equations, with its depth eliminated.

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "motion/pose_constants.hpp"
#include "motion/residuals.hpp"

namespace quadedge::pose {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr double kReprojectionSize = 3, kDirectionSize = 2;  ///< residuals per block
/// Medians of the chi-squared distribution with 3, 2 and 1 degrees of freedom.
constexpr double kReprojectionMedian = 2.3659738843753377, kDirectionMedian = 1.3862943611198906,
                 kOffsetMedian = 0.4549364231195724;

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

/// Weighting of errors.
struct StudentWeights {
  double scale = 1;  ///< ratio of measured to assumed variance
  double dof = 5;
};

/// The pose and the weights at which all quads are evaluated.
struct Evaluation {
  /// \param current_from_previous R, T [m] \param offset added to all disparities [px]
  Evaluation(const Eigen::Isometry3d& current_from_previous, double offset, const StudentWeights& weights);

  double rotation[3][3];
  Vector3 translation;
  double offset;
  StudentWeights weights;
};

/// With respect to the pose: upper triangle of the matrix row by row, then the gradient. With the offset, in addition:
/// its six mixed terms with the pose, its square and its gradient.
constexpr std::size_t kMatrixValues = 21, kPoseValues = kMatrixValues + 6, kOffsetValues = kPoseValues + 8;

/// Reads the upper triangle of a pose's matrix from `values`, at intervals of `stride`, row by row.
template <int Size>
void unpack_pose(const double* values, std::size_t stride, Eigen::Matrix<double, Size, Size>& matrix) {
  for (int r = 0; r < 6; ++r) {
    for (int c = r; c < 6; ++c) {
      matrix(r, c) = matrix(c, r) = *values;
      values += stride;
    }
  }
}

/// Contributions of each of `Width` quads to the normal equations with respect to the pose, a left perturbation of
/// current_from_previous by (rotation [rad], translation [m]), or with respect to the pose and the offset [px].
/// \tparam Values kPoseValues or kOffsetValues
template <std::size_t Values, std::size_t Width>
struct Contributions {
  double values[Values][Width];
  double depth[Width];  ///< updated depth unknowns of the quads
  double error[Width];  ///< squared Mahalanobis errors; -1 for a quad behind the camera, which contributes nothing

  Matrix6d matrix(std::size_t lane) const {
    Matrix6d result;
    unpack_pose(&values[0][lane], Width, result);
    return result;
  }
  Vector6d gradient(std::size_t lane) const {
    Vector6d result;
    for (std::size_t r = 0; r < 6; ++r) result(static_cast<Eigen::Index>(r)) = values[kMatrixValues + r][lane];
    return result;
  }

  template <class... Value>
  [[gnu::always_inline]] void set(std::size_t lane, std::size_t first, Value... value) {
    ((values[first++][lane] = value), ...);
  }
};

/// Residuals of a quad after elimination of its depth. With the derivatives G of the residuals with respect to the
/// homogeneous point and h with respect to the depth unknown, which has a standard normal prior, they are weighted by
///   P = I - h h^T / (1 + h^T h).
struct Eliminated {
  const ReprojectionResidual& at;
  double shrink;           ///< 1 / (1 + h^T h)
  Vector3 depth_by_point;  ///< h^T G

  [[gnu::always_inline]] explicit Eliminated(const ReprojectionResidual& residual) : at(residual) {
    const Residuals& h = at.by_depth;
    const Vector3 &g0 = at.across_by_point, &g1 = at.along_by_point;
    shrink = 1.0 / (1.0 + h.across * h.across + h.along * h.along + h.inverse_depth * h.inverse_depth);
    depth_by_point = {h.across * g0.x + h.along * g1.x, h.across * g0.y + h.along * g1.y,
                      h.across * g0.z + h.along * g1.z + h.inverse_depth * at.inverse_depth_by_z};
  }
  /// G^T P G
  [[gnu::always_inline]] Symmetric3 matrix() const {
    const Vector3 &g0 = at.across_by_point, &g1 = at.along_by_point, &q = depth_by_point;
    const double gz = at.inverse_depth_by_z;
    return {g0.x * g0.x + g1.x * g1.x - shrink * q.x * q.x, g0.x * g0.y + g1.x * g1.y - shrink * q.x * q.y,
            g0.x * g0.z + g1.x * g1.z - shrink * q.x * q.z, g0.y * g0.y + g1.y * g1.y - shrink * q.y * q.y,
            g0.y * g0.z + g1.y * g1.z - shrink * q.y * q.z, g0.z * g0.z + g1.z * g1.z + gz * gz - shrink * q.z * q.z};
  }
  /// G^T P r for residuals r with `taken` = shrink h^T r
  [[gnu::always_inline]] Vector3 project(const Residuals& r, double taken) const {
    const Vector3 &g0 = at.across_by_point, &g1 = at.along_by_point, &q = depth_by_point;
    return {g0.x * r.across + g1.x * r.along - taken * q.x, g0.y * r.across + g1.y * r.along - taken * q.y,
            g0.z * r.across + g1.z * r.along + at.inverse_depth_by_z * r.inverse_depth - taken * q.z};
  }
};

/// Contribution of one quad to the normal equations. With M = w G^T Q G and b = w G^T Q e, where w is its weight and e
/// its residuals, a perturbation (w, v) of the pose, which moves the homogeneous point y by w x y + rho v, gives
///   matrix: [y] M [y]^T, rho [y] M, rho^2 M;   gradient: y x b, rho b.
/// The quad's own disparity error has the derivative o of a common offset and the variance s^2, so that
///   Q = P - P o o^T P / (1 / s^2 + o^T P o).
/// \param depth the depth unknown of the quad \param lane of `result`
template <std::size_t Values, std::size_t Width>
[[gnu::always_inline]] inline void contribute(const ReprojectionTerm& term, double depth, const Evaluation& at,
                                              std::size_t lane, Contributions<Values, Width>& result) {
  const auto& r = at.rotation;
  const double rho = term.inverse_depth + depth * term.inverse_depth_sigma;
  const Vector3 y = {r[0][0] * term.ray_x + r[0][1] * term.ray_y + r[0][2] + rho * at.translation.x,
                     r[1][0] * term.ray_x + r[1][1] * term.ray_y + r[1][2] + rho * at.translation.y,
                     r[2][0] * term.ray_x + r[2][1] * term.ray_y + r[2][2] + rho * at.translation.z};
  const ReprojectionResidual residual = reprojection_residual(term, y, rho, at.translation);
  const Residuals &h = residual.by_depth, &o = residual.by_offset;
  const Residuals e = {residual.value.across + o.across * at.offset - h.across * depth,
                       residual.value.along + o.along * at.offset - h.along * depth,
                       residual.value.inverse_depth + o.inverse_depth * at.offset - h.inverse_depth * depth};

  const Eliminated eliminated(residual);
  const double he = dot(h, e), taken = eliminated.shrink * he;
  const double ho = dot(h, o), taken_o = eliminated.shrink * ho;
  // The error of the quad's own disparities is eliminated after its depth.
  const double oo = dot(o, o) - taken_o * ho, oe = dot(o, e) - taken_o * he;
  const double left_over = 1.0 / (1.0 + term.disparity_variance * oo), gain = term.disparity_variance * left_over;
  const double cost = dot(e, e) - taken * he - gain * oe * oe;
  const double in_front_weight =
      student_weight(cost, at.weights.scale, kReprojectionSize, at.weights.dof) / at.weights.scale;
  const double weight = residual.in_front ? in_front_weight : 0.0;
  result.depth[lane] = residual.in_front ? gain * oe * taken_o - taken : depth;
  result.error[lane] = residual.in_front ? cost : -1.0;

  const Vector3 g = eliminated.project(o, taken_o);
  const Symmetric3 a = eliminated.matrix();
  const Symmetric3 m = weight * Symmetric3{a.xx - gain * g.x * g.x, a.xy - gain * g.x * g.y, a.xz - gain * g.x * g.z,
                                           a.yy - gain * g.y * g.y, a.yz - gain * g.y * g.z, a.zz - gain * g.z * g.z};
  const Vector3 kx = cross(y, m.column_x()), ky = cross(y, m.column_y()), kz = cross(y, m.column_z());  // [y] M
  const Vector3 turned_x = cross(y, {kx.x, ky.x, kz.x}), turned_y = cross(y, {kx.y, ky.y, kz.y}),
                turned_z = cross(y, {kx.z, ky.z, kz.z});  // rows of [y] M [y]^T
  const Symmetric3 shifted = rho * rho * m;
  // Of the residuals without what the error explains, e - gain o^T P e o.
  const Vector3 b0 = eliminated.project(e, taken), b1 = gain * oe * g;
  const Vector3 b = weight * Vector3{b0.x - b1.x, b0.y - b1.y, b0.z - b1.z}, yb = cross(y, b);
  result.set(lane, 0, turned_x.x, turned_x.y, turned_x.z, rho * kx.x, rho * ky.x, rho * kz.x,  //
             turned_y.y, turned_y.z, rho * kx.y, rho * ky.y, rho * kz.y,                       //
             turned_z.z, rho * kx.z, rho * ky.z, rho * kz.z,                                   //
             shifted.xx, shifted.xy, shifted.xz, shifted.yy, shifted.yz, shifted.zz,           //
             yb.x, yb.y, yb.z, rho * b.x, rho * b.y, rho * b.z);
  if constexpr (Values == kOffsetValues) {
    const double offset_weight = weight * left_over;
    const Vector3 c = offset_weight * g, yc = cross(y, c);
    result.set(lane, kPoseValues, yc.x, yc.y, yc.z, rho * c.x, rho * c.y, rho * c.z,  //
               offset_weight * oo, offset_weight * oe);
  }
}

}  // namespace quadedge::pose
