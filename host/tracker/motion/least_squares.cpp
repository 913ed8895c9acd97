/// \file least_squares.cpp  Scales by a quickselect without branches; perturbations by unit quaternions.
#include "motion/least_squares.hpp"

#include <algorithm>

namespace quadedge::pose {

namespace {

/// Number of values that are simply sorted.
constexpr std::size_t kFewValues = 16;

/// Keeps the values with is_kept(value), in their order. \returns their number. Without branches, which could not be
/// predicted.
template <class IsKept>
std::size_t compact(double* values, std::size_t count, const IsKept& is_kept) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double value = values[i];
    values[kept] = value;
    kept += is_kept(value) ? 1 : 0;
  }
  return kept;
}

/// The value of rank `rank`, counted from 0, of `count` > rank values, which are overwritten (quickselect).
double value_of_rank(double* values, std::size_t count, std::size_t rank) {
  while (count > kFewValues) {
    double sample[] = {values[count / 4], values[count / 2], values[count / 4 * 3]};
    std::sort(std::begin(sample), std::end(sample));
    const double pivot = sample[1];
    std::size_t below = 0, equal = 0;
    for (std::size_t i = 0; i < count; ++i) {
      below += values[i] < pivot ? 1 : 0;
      equal += values[i] == pivot ? 1 : 0;
    }
    if (rank >= below && rank < below + equal) return pivot;
    if (rank < below) {
      count = compact(values, count, [&](double value) { return value < pivot; });
    } else {
      rank -= below + equal;
      count = compact(values, count, [&](double value) { return value > pivot; });
    }
    if (rank >= count) return pivot;  // not a number
  }
  std::sort(values, values + count);
  return values[rank];
}

}  // namespace

double measured_scale(const std::vector<double>& errors, std::size_t count, double median_of_one,
                      std::vector<double>& values) {
  const std::size_t every = std::max<std::size_t>(1, count / kScaleErrors);
  values.resize((count + every - 1) / every);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = errors[k * every];
  return std::max(value_of_rank(values.data(), values.size(), values.size() / 2) / median_of_one, kSmallestScale);
}

Eigen::Isometry3d perturb(const Vector6d& step, const Eigen::Isometry3d& current_from_previous) {
  const Eigen::Vector3d w = step.head<3>();
  const double angle = w.norm();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (angle > 0) turn = Eigen::Quaterniond(Eigen::AngleAxisd(angle, w / angle));
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  // Renormalised as a unit quaternion, so that the rotation stays orthonormal after many steps.
  result.linear() = (turn * Eigen::Quaterniond(current_from_previous.linear())).normalized().toRotationMatrix();
  result.translation() = turn * current_from_previous.translation() + step.tail<3>();
  return result;
}

Evaluation::Evaluation(const Eigen::Isometry3d& current_from_previous, double offset_px, const StudentWeights& student)
    : offset(offset_px), weights(student) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) rotation[r][c] = current_from_previous.linear()(r, c);
  const auto& t = current_from_previous.translation();
  translation = {t.x(), t.y(), t.z()};
}

}  // namespace quadedge::pose
