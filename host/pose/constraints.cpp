#include "pose/constraints.hpp"

#include <cmath>

namespace quadedge::pose {

ConstraintLimits::ConstraintLimits(const PoseConfig& config)
    : length(config.length_difference),
      angle(config.angle_difference),
      tangent(config.tangent_difference),
      max_cosine(std::cos(config.min_angle_rad())),
      determinant(config.min_determinant) {}

ConstraintCheck check_constraints(const OrientedPair& previous, const OrientedPair& current,
                                  const ConstraintLimits& limits) {
  ConstraintCheck check;
  const double tangents = previous.first.tangent.dot(previous.second.tangent);
  const double tangents_bar = current.first.tangent.dot(current.second.tangent);
  check.passed[3] = std::abs(tangents - tangents_bar) < limits.tangent;

  const Eigen::Vector3d d = previous.second.point - previous.first.point;
  const Eigen::Vector3d d_bar = current.second.point - current.first.point;
  const double length = d.norm(), length_bar = d_bar.norm();
  if (!(length > 0) || !(length_bar > 0)) return check;
  const Eigen::Vector3d unit = d / length, unit_bar = d_bar / length_bar;
  const double first = unit.dot(previous.first.tangent), first_bar = unit_bar.dot(current.first.tangent);
  const double second = unit.dot(previous.second.tangent), second_bar = unit_bar.dot(current.second.tangent);
  check.passed[0] = std::abs(length - length_bar) < limits.length * length;
  check.passed[1] = std::abs(first - first_bar) < limits.angle;
  check.passed[2] = std::abs(second - second_bar) < limits.angle;

  const bool first_crosses = std::abs(first) < limits.max_cosine && std::abs(first_bar) < limits.max_cosine;
  const bool second_crosses = std::abs(second) < limits.max_cosine && std::abs(second_bar) < limits.max_cosine;
  check.passed[4] = first_crosses || second_crosses;
  check.swapped = !first_crosses && second_crosses;

  const double determinant = unit.dot(previous.first.tangent.cross(previous.second.tangent));
  const double determinant_bar = unit_bar.dot(current.first.tangent.cross(current.second.tangent));
  const bool informative = std::abs(determinant) > limits.determinant && std::abs(determinant_bar) > limits.determinant;
  check.passed[5] = !informative || (determinant > 0) == (determinant_bar > 0);
  return check;
}

}  // namespace quadedge::pose
