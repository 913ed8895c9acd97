/// \file two_quads.cpp  Aligns the orthonormal frames of both pairs and their midpoints; compares six invariants.
#include "motion/two_quads.hpp"

#include <cmath>
#include <utility>

#include "motion/pose_constants.hpp"

namespace quadedge::pose {

namespace {

/// D and a tangent count as parallel if the magnitude of their cosine exceeds this.
const double kMaxCosine = std::cos(kMinAngleDeg * kDegree);

/// Computes the orthonormal frame [e1 e2 e3] of a pair; returns false if it is undefined.
bool build_frame(const OrientedPair& pair, Eigen::Matrix3d& frame) {
  const Eigen::Vector3d d = pair.second.point - pair.first.point;
  const double length = d.norm();
  if (!(length > 0)) return false;
  const Eigen::Vector3d e1 = d / length;
  const double cosine = e1.dot(pair.first.tangent);
  if (!(std::abs(cosine) < kMaxCosine)) return false;
  const Eigen::Vector3d e2 = (pair.first.tangent - cosine * e1).normalized();
  frame << e1, e2, e1.cross(e2);
  return true;
}

}  // namespace

ConstraintCheck check_constraints(const OrientedPair& previous, const OrientedPair& current) {
  ConstraintCheck check;
  const double tangents = previous.first.tangent.dot(previous.second.tangent);
  const double tangents_bar = current.first.tangent.dot(current.second.tangent);
  check.passed[3] = std::abs(tangents - tangents_bar) < kTangentDifference;

  const Eigen::Vector3d d = previous.second.point - previous.first.point;
  const Eigen::Vector3d d_bar = current.second.point - current.first.point;
  const double length = d.norm(), length_bar = d_bar.norm();
  if (!(length > 0) || !(length_bar > 0)) return check;
  const Eigen::Vector3d unit = d / length, unit_bar = d_bar / length_bar;
  const double first = unit.dot(previous.first.tangent), first_bar = unit_bar.dot(current.first.tangent);
  const double second = unit.dot(previous.second.tangent), second_bar = unit_bar.dot(current.second.tangent);
  check.passed[0] = std::abs(length - length_bar) < kLengthDifference * length;
  check.passed[1] = std::abs(first - first_bar) < kAngleDifference;
  check.passed[2] = std::abs(second - second_bar) < kAngleDifference;

  const bool first_crosses = std::abs(first) < kMaxCosine && std::abs(first_bar) < kMaxCosine;
  const bool second_crosses = std::abs(second) < kMaxCosine && std::abs(second_bar) < kMaxCosine;
  check.passed[4] = first_crosses || second_crosses;
  check.swapped = !first_crosses && second_crosses;

  const double determinant = unit.dot(previous.first.tangent.cross(previous.second.tangent));
  const double determinant_bar = unit_bar.dot(current.first.tangent.cross(current.second.tangent));
  const bool informative = std::abs(determinant) > kMinDeterminant && std::abs(determinant_bar) > kMinDeterminant;
  check.passed[5] = !informative || (determinant > 0) == (determinant_bar > 0);
  return check;
}

std::optional<Eigen::Isometry3d> solve_two_quads(const OrientedPair& previous, const OrientedPair& current) {
  Eigen::Matrix3d frame, frame_bar;
  if (!build_frame(previous, frame) || !build_frame(current, frame_bar)) return std::nullopt;
  Eigen::Isometry3d current_from_previous = Eigen::Isometry3d::Identity();
  current_from_previous.linear() = frame_bar * frame.transpose();
  current_from_previous.translation() =
      0.5 * (current.first.point + current.second.point -
             current_from_previous.linear() * (previous.first.point + previous.second.point));
  return current_from_previous;
}

std::optional<Eigen::Isometry3d> solve_constrained(OrientedPair& previous, OrientedPair& current) {
  const ConstraintCheck check = check_constraints(previous, current);
  if (!check.all()) return std::nullopt;
  if (check.swapped)
    for (OrientedPair* pair : {&previous, &current}) std::swap(pair->first, pair->second);
  return solve_two_quads(previous, current);
}

}  // namespace quadedge::pose
