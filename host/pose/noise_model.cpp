#include "pose/noise_model.hpp"

#include <cmath>

namespace quadedge::pose {

NoiseModel::NoiseModel(const PoseConfig& config)
    : across(config.sigma_across), along(config.sigma_along), direction(config.sigma_direction_rad()) {}

double NoiseModel::on_epipolar_line(double epipolar_sine) const {
  const double by_across = epipolar_sine / across;
  const double by_along = (1.0 - epipolar_sine * epipolar_sine) / (along * along);
  return 1.0 / std::sqrt(by_across * by_across + by_along);
}

}  // namespace quadedge::pose
