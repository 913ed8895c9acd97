#include "pose/residuals.hpp"

#include <cmath>

#include "common/angles.hpp"

namespace quadedge::pose {

NoiseModel::NoiseModel(const PoseConfig& config)
    : across(config.sigma_across), along(config.sigma_along), direction(radians(config.sigma_direction)) {}

double NoiseModel::on_epipolar_line(double epipolar_sine) const {
  const double by_across = epipolar_sine / across;
  const double by_along = (1.0 - epipolar_sine * epipolar_sine) / (along * along);
  return 1.0 / std::sqrt(by_across * by_across + by_along);
}

FitTerm make_term(const QuadObservations& quads, std::size_t quad, const NoiseModel& noise) {
  const double plane_weight = 1.0 / (std::sqrt(2.0) * noise.direction);  // directions of both times are noisy
  const StereoMeasurement &before = quads.previous[quad], &after = quads.current[quad];
  FitTerm term;
  term.ray = before.ray;
  term.inverse_depth = before.inverse_depth;
  term.inverse_depth_sigma = before.inverse_depth_per_pixel * noise.on_epipolar_line(before.epipolar_sine);
  term.inverse_depth_per_pixel = before.inverse_depth_per_pixel;
  term.inverse_depth_bar_per_pixel = after.inverse_depth_per_pixel;
  const double cosine = quads.scoring.left_cos[quad], sine = quads.scoring.left_sin[quad];
  term.across = Eigen::Vector2d(-sine, cosine) / noise.across;
  term.along = Eigen::Vector2d(cosine, sine) / noise.along;
  term.place = {after.ray.x(), after.ray.y()};
  term.inverse_depth_bar = after.inverse_depth;
  term.inverse_depth_bar_weight = 1.0 / (after.inverse_depth_per_pixel * noise.on_epipolar_line(after.epipolar_sine));
  term.tangent = before.direction + before.slope * before.ray;
  term.slope_sigma = before.slope_per_radian * noise.direction;
  term.left_normal = after.left_normal * plane_weight;
  term.right_normal = after.right_normal * plane_weight;
  return term;
}

bool linearise(const FitTerm& term, const PinholeCamera& left, const Eigen::Isometry3d& current_from_previous,
               double depth, Linearisation& result) {
  const Eigen::Vector3d ray = current_from_previous.linear() * term.ray;
  const Eigen::Vector3d translation = current_from_previous.translation();
  const double rho = term.inverse_depth + depth * term.inverse_depth_sigma;
  // Homogeneous point, the scene point times rho: regular for points at infinity.
  const Eigen::Vector3d y = ray + rho * translation;
  if (!(y.z() > 0)) return false;
  const double inverse = 1.0 / y.z();
  const double u = y.x() * inverse, v = y.y() * inverse;
  const Eigen::Vector2d error(left.fx * (u - term.place.x()), left.fy * (v - term.place.y()));

  Eigen::Matrix3d by_point;  // rows: residual by y
  const auto fill = [&](int row, const Eigen::Vector2d& axis) {
    const double a = axis.x() * left.fx * inverse, b = axis.y() * left.fy * inverse;
    by_point.row(row) << a, b, -(a * u + b * v);
    result.place(row) = axis.dot(error);
  };
  fill(0, term.across);
  fill(1, term.along);
  const double weight = term.inverse_depth_bar_weight;
  result.place(2) = (rho * inverse - term.inverse_depth_bar) * weight;
  by_point.row(2) << 0, 0, -rho * inverse * inverse * weight;

  result.place_by_depth = by_point * translation;
  result.place_by_depth(2) += inverse * weight;
  result.place_by_offset = result.place_by_depth * term.inverse_depth_per_pixel;
  result.place_by_offset(2) -= weight * term.inverse_depth_bar_per_pixel;
  result.place_by_depth *= term.inverse_depth_sigma;
  for (int row = 0; row < 3; ++row) {
    const Eigen::Vector3d g = by_point.row(row);
    result.place_by_pose.block<1, 3>(row, 0) = y.cross(g).transpose();
    result.place_by_pose.block<1, 3>(row, 3) = rho * g.transpose();
  }

  const Eigen::Vector3d tangent = current_from_previous.linear() * term.tangent;
  result.direction << term.left_normal.dot(tangent), term.right_normal.dot(tangent);
  result.direction_by_rotation.row(0) = tangent.cross(term.left_normal).transpose();
  result.direction_by_rotation.row(1) = tangent.cross(term.right_normal).transpose();
  result.direction_by_slope << term.left_normal.dot(ray), term.right_normal.dot(ray);
  result.direction_by_slope *= term.slope_sigma;
  return true;
}

}  // namespace quadedge::pose
