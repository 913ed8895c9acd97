/// \file rig_change.cpp  Measures, with the given calibration, points that the other one projects, on a grid of pixels.
#include "calibration/rig_change.hpp"

#include <cmath>
#include <vector>

#include "common/numeric.hpp"
#include "geometry/lens_mapping.hpp"

namespace quadedge {

Eigen::Vector2d displacement(const StereoCalibration& given, const StereoCalibration& learned, Side side,
                             const Eigen::Vector2d& pixel) {
  Eigen::Vector2d none(kNan, kNan);
  const bool is_left = side == Side::left;
  const auto ray = LensMapping(is_left ? learned.left : learned.right).ray(pixel);
  if (!ray) return none;
  const Eigen::Matrix3d turn =
      is_left ? Eigen::Matrix3d::Identity()
              : Eigen::Matrix3d(given.right_from_left.linear() * learned.right_from_left.linear().transpose());
  const auto seen = LensMapping(is_left ? given.left : given.right).project(turn * *ray);
  return seen ? Eigen::Vector2d(*seen - pixel) : none;
}

namespace rig {
namespace {

constexpr int kCellColumns = 12, kCellRows = 8;

/// The middles of the cells of an image.
std::vector<Eigen::Vector2d> cells_of(const PinholeCamera& camera) {
  std::vector<Eigen::Vector2d> cells;
  for (int row = 0; row < kCellRows; ++row)
    for (int column = 0; column < kCellColumns; ++column)
      cells.emplace_back((column + 0.5) * camera.width / kCellColumns, (row + 0.5) * camera.height / kCellRows);
  return cells;
}

}  // namespace

double depth_error(const StereoCalibration& given, const StereoCalibration& learned, double depth) {
  const LensMapping learned_lenses[] = {LensMapping(learned.left), LensMapping(learned.right)},
                    given_lenses[] = {LensMapping(given.left), LensMapping(given.right)};
  std::vector<double> errors;
  for (const Eigen::Vector2d& pixel : cells_of(given.left.camera)) {
    const auto true_ray = learned_lenses[0].ray(pixel), ray = given_lenses[0].ray(pixel);
    if (!true_ray || !ray || !(true_ray->z() > 0.1)) continue;
    const auto right = learned_lenses[1].project(learned.right_from_left * (*true_ray * (depth / true_ray->z())));
    if (!right || right->minCoeff() < 0 || right->x() > given.right.camera.width - 1 ||
        right->y() > given.right.camera.height - 1)
      continue;
    const auto right_ray = given_lenses[1].ray(*right);
    if (!right_ray) continue;
    const Eigen::Vector3d by_depth = given.right_from_left.translation().cross(*right_ray);
    const double inverse = -(given.right_from_left.linear() * *ray).cross(*right_ray).dot(by_depth) /
                           by_depth.squaredNorm();  // of the distance
    errors.push_back(std::abs(ray->z() / (inverse * depth) - 1));
  }
  return errors.empty() ? kNan : upper_median(errors);
}

CalibrationChange change_of(const StereoCalibration& given, const StereoCalibration& learned) {
  CalibrationChange change;
  for (const double depth : {1, 2, 5, 10, 50}) change.depths.push_back({depth, depth_error(given, learned, depth)});
  change.rotation =
      Eigen::AngleAxisd(learned.right_from_left.linear() * given.right_from_left.linear().transpose()).angle();
  for (const Side side : kSides) {
    for (const Eigen::Vector2d& pixel : cells_of((side == Side::left ? given.left : given.right).camera)) {
      const double distance = displacement(given, learned, side, pixel).norm();
      double& largest = change.largest_displacement[static_cast<std::size_t>(index_of(side))];
      if (distance > largest) largest = distance;
    }
  }
  return change;
}

}  // namespace rig
}  // namespace quadedge
