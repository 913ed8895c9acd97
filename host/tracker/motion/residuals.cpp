/// \file residuals.cpp  Divides residuals by their noise: across and along the edge, of its depth and its tangent.
#include "motion/residuals.hpp"

#include <cmath>

#include "motion/pose_constants.hpp"

namespace quadedge::pose {

namespace {

/// Standard deviation of an edge's position along the segment of curve that it represents, in half lengths: that of a
/// uniform distribution.
constexpr double kSliding = 0.57735027;

/// Errors that the calibration leaves in the disparities of neighbouring edges are alike and do not average out as
/// those of independent ones would; they count so much more.
constexpr double kAlikeErrors = 1.5;

}  // namespace

NoiseModel::NoiseModel(const PoseConfig& config, double disparity_px)
    : across(config.sigma_across),
      along(kSigmaAlong),
      disparity(kAlikeErrors * disparity_px),
      direction(kSigmaDirection) {}

double NoiseModel::on_epipolar_line(double epipolar_sine) const {
  const double by_across = epipolar_sine / across;
  const double by_along = (1.0 - epipolar_sine * epipolar_sine) / (along * along);
  return 1.0 / std::sqrt(by_across * by_across + by_along);
}

double NoiseModel::along_in_time(double half_length, double scale) const {
  return std::sqrt(along * along + std::pow(kSliding * half_length / scale, 2));
}

ReprojectionTerm make_reprojection_term(const QuadObservations& quads, std::size_t quad, const PinholeCamera& left,
                                        const NoiseModel& noise, double scale) {
  const StereoMeasurement &previous = quads.previous[quad], &current = quads.current[quad];
  const double cosine = quads.scoring.left_cos[quad], sine = quads.scoring.left_sin[quad];
  ReprojectionTerm term;
  term.ray_x = previous.ray.x();
  term.ray_y = previous.ray.y();
  term.inverse_depth = previous.inverse_depth;
  term.inverse_depth_sigma = previous.inverse_depth_per_pixel * noise.on_epipolar_line(previous.epipolar_sine);
  term.inverse_depth_per_pixel = previous.inverse_depth_per_pixel;
  term.current_inverse_depth_per_pixel = current.inverse_depth_per_pixel;
  term.current_x = current.ray.x();
  term.current_y = current.ray.y();
  // Each edge is moved to the scale half-way between the two.
  term.scale_shift_x = 0.5 * (previous.scale_shift.x() + current.scale_shift.x());
  term.scale_shift_y = 0.5 * (previous.scale_shift.y() + current.scale_shift.y());
  term.across_x = -sine / noise.across * left.fx;
  term.across_y = cosine / noise.across * left.fy;
  const double along = noise.along_in_time(static_cast<double>(quads.scoring.half_length), scale);
  term.along_x = cosine / along * left.fx;
  term.along_y = sine / along * left.fy;
  term.current_inverse_depth = current.inverse_depth;
  term.current_inverse_depth_weight =
      1.0 / (current.inverse_depth_per_pixel * noise.on_epipolar_line(current.epipolar_sine));
  term.disparity_variance = noise.disparity * noise.disparity / (scale * scale);
  return term;
}

DirectionTerm make_direction_term(const QuadObservations& quads, std::size_t quad, const NoiseModel& noise) {
  const StereoMeasurement &previous = quads.previous[quad], &current = quads.current[quad];
  const double plane_weight = 1.0 / (std::sqrt(2.0) * noise.direction);  // the directions at both times are noisy
  const auto vector = [](const Eigen::Vector3d& v) -> Vector3 { return {v.x(), v.y(), v.z()}; };
  return {vector(previous.direction + previous.slope * previous.ray), previous.slope_per_radian * noise.direction,
          vector(current.left_normal * plane_weight), vector(current.right_normal * plane_weight)};
}

}  // namespace quadedge::pose
