#include "pose/noise_model.hpp"

#include <cmath>

namespace quadedge::pose {
namespace {

/// Standard deviation of an edge's position along the segment of curve that it represents, in half lengths: that of a
/// uniform distribution.
constexpr double kSliding = 0.57735027;

}  // namespace

NoiseModel::NoiseModel(const PoseConfig& config)
    : across(config.sigma_across), along(config.sigma_along), direction(config.sigma_direction_rad()) {}

double NoiseModel::on_epipolar_line(double epipolar_sine) const {
  const double by_across = epipolar_sine / across;
  const double by_along = (1.0 - epipolar_sine * epipolar_sine) / (along * along);
  return 1.0 / std::sqrt(by_across * by_across + by_along);
}

double NoiseModel::along_in_time(double half_length, double scale) const {
  return std::hypot(along, kSliding * half_length / scale);
}

}  // namespace quadedge::pose
