/// \file sub_paths.cpp  t_rel and r_rel: what the end of a sub-path is off, seen from its start.

#include "output/sub_paths.hpp"

#include <algorithm>
#include <cmath>

#include "common/numeric.hpp"

namespace quadedge::evaluation {
namespace {

constexpr std::size_t kStartStep = 10;  // poses from one start of a sub-path to the next

/// Length of the true path up to each pose [m].
std::vector<double> distances(const std::vector<MatchedPoses>& poses) {
  std::vector<double> sums = {0};
  for (std::size_t i = 1; i < poses.size(); ++i)
    sums.push_back(sums.back() + (poses[i].truth.translation() - poses[i - 1].truth.translation()).norm());
  return sums;
}

}  // namespace

ErrorStatistics statistics(std::vector<double> errors) {
  errors.erase(std::remove_if(errors.begin(), errors.end(), [](double error) { return std::isnan(error); }),
               errors.end());
  if (errors.empty()) return {kNan, kNan, kNan, kNan};
  ErrorStatistics result;
  const double count = static_cast<double>(errors.size());
  double sum = 0, squares = 0, deviations = 0;
  for (const double error : errors) {
    sum += error;
    squares += error * error;
    result.max = std::max(result.max, error);
  }
  result.mean = sum / count;
  for (const double error : errors) deviations += (error - result.mean) * (error - result.mean);
  result.std = std::sqrt(deviations / count);
  result.rmse = std::sqrt(squares / count);
  return result;
}

double angle_deg(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q(rotation);
  return 2 * std::atan2(q.vec().norm(), std::abs(q.w())) * kDegreesPerRadian;
}

std::vector<SubPathErrors> sub_path_errors(const std::vector<MatchedPoses>& poses, const std::vector<double>& lengths) {
  const std::vector<double> distance = distances(poses);
  std::vector<SubPathErrors> errors;
  for (const double length : lengths) {
    std::vector<double> translation, rotation;
    for (std::size_t first = 0; first < poses.size(); first += kStartStep) {
      // The first pose beyond the length, which the errors are nevertheless divided by.
      const auto end = std::upper_bound(distance.begin() + static_cast<std::ptrdiff_t>(first), distance.end(),
                                        distance[first] + length);
      if (end == distance.end()) break;
      const MatchedPoses &from = poses[first], &to = poses[static_cast<std::size_t>(end - distance.begin())];
      if (from.segment != to.segment) continue;
      const Eigen::Isometry3d off =
          (from.estimate.inverse() * to.estimate).inverse() * (from.truth.inverse() * to.truth);
      translation.push_back(100 * off.translation().norm() / length);
      rotation.push_back(angle_deg(off.linear()) / length);
    }
    const int count = static_cast<int>(translation.size());
    const ErrorStatistics t = statistics(std::move(translation)), r = statistics(std::move(rotation));
    errors.push_back({length, count, t.mean, r.mean, t.std, r.std});
  }
  return errors;
}

SubPathErrors mean_of(const std::vector<SubPathErrors>& lengths) {
  SubPathErrors mean{kNan, 0, 0, 0};
  for (const SubPathErrors& errors : lengths) {
    if (errors.count == 0) continue;
    mean.count += errors.count;
    mean.translation_percent += errors.count * errors.translation_percent;
    mean.rotation_deg_per_m += errors.count * errors.rotation_deg_per_m;
  }
  mean.translation_percent = mean.count > 0 ? mean.translation_percent / mean.count : kNan;
  mean.rotation_deg_per_m = mean.count > 0 ? mean.rotation_deg_per_m / mean.count : kNan;
  return mean;
}

}  // namespace quadedge::evaluation
