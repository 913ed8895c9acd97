/// \file rig_unknowns.cpp  Priors by lens model, and linear maps from unknowns to the numbers of each camera.
#include "calibration/rig_unknowns.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/calibration.hpp"
#include "geometry/lens_mapping.hpp"

namespace quadedge::rig {
namespace {

constexpr double kPriorFocal = 985;  // px, of the camera for which priors are stated
constexpr int kMostUnknowns = 32;

/// What a lens parameter does: names it and says how far it may be off.
struct LensParameter {
  int index;
  const char* name;
  double prior;
  int power;  ///< of the radius that its displacement grows with, if its prior is to shrink in wide lenses; else 0
};

std::vector<LensParameter> parameters_of(const Lens& lens, bool is_loose, bool is_horizontal) {
  const double p1 = is_loose && !is_horizontal ? 0.004 : 0.001, p2 = is_loose && is_horizontal ? 0.004 : 0.001;
  switch (lens.model) {
    case LensModel::radial_tangential:
      return {{0, "k1", 0.05, 0}, {1, "k2", 0.08, 0}, {2, "p1", p1, 0}, {3, "p2", p2, 0}, {4, "k3", 0.08, 0}};
    case LensModel::equidistant:
      return {{0, "k1", 0.05, 3}, {1, "k2", 0.08, 5}, {2, "k3", 0.08, 7}, {3, "k4", 0.08, 9}};
    case LensModel::field_of_view: return {{0, "w", 0.05, 0}};
    case LensModel::double_sphere: return {{0, "xi", 0.05, 0}, {1, "alpha", 0.05, 0}};
    case LensModel::extended_unified: return {{0, "alpha", 0.05, 0}, {1, "beta", 0.05, 0}};
    case LensModel::omnidirectional: {
      const double scale = 1 + lens.parameters[0];
      return {{1, "k1", 0.05 * scale * scale, 3},
              {2, "k2", 0.08 * std::pow(scale, 4), 5},
              {3, "p1", p1 * scale, 0},
              {4, "p2", p2 * scale, 0}};
    }
  }
  return {};
}

/// Radius of the image's corner in the units of the lens's polynomial.
double corner_radius(const Lens& lens) {
  const PinholeCamera& camera = lens.camera;
  const auto ray = LensMapping(lens).ray(Eigen::Vector2d(0, 0));
  if (!ray) return std::hypot(camera.cx / camera.fx, camera.cy / camera.fy);
  const double angle = std::atan2(ray->head<2>().norm(), ray->z());
  if (lens.model == LensModel::equidistant) return angle;
  return lens.model == LensModel::omnidirectional ? std::hypot(camera.cx / camera.fx, camera.cy / camera.fy)
                                                  : std::tan(std::min(angle, 1.5));
}

}  // namespace

RigUnknowns::RigUnknowns(StereoCalibration given, bool has_k3) : given_(std::move(given)), has_k3_(has_k3) {
  const Eigen::Vector3d along = -given_.right_from_left.translation().normalized();  // x of a rectified rig
  const Eigen::Vector3d forward = (Eigen::Vector3d::UnitZ() - along.z() * along).normalized(),
                        across = forward.cross(along);
  rotation_axes_ << along, across, forward;
  baseline_axes_ << across, forward;
  is_horizontal_ = std::abs(along.x()) >= std::abs(along.y());
  for (auto& map : by_unknowns_) map = Eigen::MatrixXd::Zero(kFirstLensParameter, kMostUnknowns);
  add_cameras();
  add_lens(Side::left);
  add_lens(Side::right);
  add_pose();
  for (auto& map : by_unknowns_) map.conservativeResize(Eigen::NoChange, count());
}

int RigUnknowns::add(std::string name, std::string unit, double prior) {
  unknowns_.push_back({std::move(name), std::move(unit), 0, prior, prior});
  return count() - 1;
}

void RigUnknowns::add_cameras() {
  const double pixel = given_.left.camera.fx / kPriorFocal;
  Eigen::MatrixXd &left = by_unknowns_[0], &right = by_unknowns_[1];
  const auto set = [&](int unknown, bool of_left, std::initializer_list<int> numbers) {
    for (const int number : numbers) {
      if (of_left) left(number, unknown) = 1;
      right(number, unknown) = 1;
    }
  };
  set(add(kCommonFocal, "", 1 / kPriorFocal), true, {kFocalX, kFocalY});
  set(add("focal length, right", "", 5 / kPriorFocal), false, {kFocalX, kFocalY});
  set(add("fy / fx, both", "", 3 / kPriorFocal), true, {kFocalY});
  set(add("fy / fx, right", "", 3 / kPriorFocal), false, {kFocalY});
  set(add("cx, both", "px", pixel), true, {kCentreX});
  set(add("cy, both", "px", pixel), true, {kCentreY});
  const double along = 30 * pixel, across = 10 * pixel;
  set(add("cx, right", "px", is_horizontal_ ? along : across), false, {kCentreX});
  set(add("cy, right", "px", is_horizontal_ ? across : along), false, {kCentreY});
}

void RigUnknowns::add_lens(Side side) {
  Lens& lens = side == Side::left ? given_.left : given_.right;
  const double radius = corner_radius(lens);
  constexpr double kUsualRadius = 0.8;  // of the corner of the images that the priors were found with
  Eigen::MatrixXd& map = by_unknowns_[index_of(side)];
  auto parameters = parameters_of(lens, side == Side::right, is_horizontal_);
  if (lens.model == LensModel::radial_tangential && !has_k3_) parameters.pop_back();
  const auto fewest = static_cast<std::size_t>(parameters.back().index) + 1;  // those that are missing are 0
  lens.parameters.resize(std::max(lens.parameters.size(), fewest));
  map.conservativeResizeLike(
      Eigen::MatrixXd::Zero(kFirstLensParameter + static_cast<Eigen::Index>(parameters.size()), kMostUnknowns));
  for (const LensParameter& parameter : parameters) {
    const double shrink = parameter.power == 0 ? 1 : std::min(1.0, std::pow(kUsualRadius / radius, parameter.power));
    const int unknown =
        add(std::string(parameter.name) + (side == Side::left ? ", left" : ", right"), "", parameter.prior * shrink);
    auto& indices = lens_parameters_[index_of(side)];
    map(kFirstLensParameter + static_cast<Eigen::Index>(indices.size()), unknown) = 1;
    indices.push_back(parameter.index);
  }
}

void RigUnknowns::add_pose() {
  constexpr double kAboutBaseline = 0.01, kInPlane = 0.04, kAboutAxis = 0.0087;  // rad
  first_rotation_ =
      add(is_horizontal_ ? "pitch of the right camera" : "yaw of the right camera", "rad", kAboutBaseline);
  add(is_horizontal_ ? "yaw of the right camera" : "pitch of the right camera", "rad", kInPlane);
  add("roll of the right camera", "rad", kAboutAxis);
  add("baseline across", "baselines", 0.01);
  add("baseline forward", "baselines", 0.08);
}

Eigen::VectorXd RigUnknowns::priors() const {
  Eigen::VectorXd result(count());
  for (int i = 0; i < count(); ++i) result[i] = (*this)[i].prior;
  return result;
}

StereoCalibration RigUnknowns::at(const Eigen::VectorXd& values) const {
  StereoCalibration result = given_;
  for (const Side side : kSides) {
    Lens& lens = side == Side::left ? result.left : result.right;
    const Eigen::VectorXd numbers = by_unknowns(side) * values;
    lens.camera.fx *= 1 + numbers[kFocalX];
    lens.camera.fy *= 1 + numbers[kFocalY];
    lens.camera.cx += numbers[kCentreX];
    lens.camera.cy += numbers[kCentreY];
    for (std::size_t k = 0; k < lens_parameters(side).size(); ++k)
      lens.parameters[static_cast<std::size_t>(lens_parameters(side)[k])] +=
          numbers[kFirstLensParameter + static_cast<Eigen::Index>(k)];
  }
  result.right_from_left.linear() =
      rotation_by(rotation_axes_ * values.segment<3>(first_rotation_)) * given_.right_from_left.linear();
  const Eigen::Vector3d given = given_.right_from_left.translation(),
                        moved = given + baseline_slope() * values.segment<2>(first_rotation_ + 3);
  result.right_from_left.translation() = given.norm() * moved.normalized();
  return result;
}

}  // namespace quadedge::rig
