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

double angle_deg(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q(rotation);
  return 2 * std::atan2(q.vec().norm(), std::abs(q.w())) * kDegreesPerRadian;
}

std::vector<SubPathErrors> sub_path_errors(const std::vector<MatchedPoses>& poses, const std::vector<double>& lengths) {
  const std::vector<double> distance = distances(poses);
  std::vector<SubPathErrors> errors;
  for (const double length : lengths) {
    SubPathErrors sum{length, 0, 0, 0};
    for (std::size_t first = 0; first < poses.size(); first += kStartStep) {
      // The first pose beyond the length, which the errors are nevertheless divided by.
      const auto end = std::upper_bound(distance.begin() + static_cast<std::ptrdiff_t>(first), distance.end(),
                                        distance[first] + length);
      if (end == distance.end()) break;
      const MatchedPoses &from = poses[first], &to = poses[static_cast<std::size_t>(end - distance.begin())];
      if (from.segment != to.segment) continue;
      const Eigen::Isometry3d off =
          (from.estimate.inverse() * to.estimate).inverse() * (from.truth.inverse() * to.truth);
      ++sum.count;
      sum.translation_percent += 100 * off.translation().norm() / length;
      sum.rotation_deg_per_m += angle_deg(off.linear()) / length;
    }
    sum.translation_percent = sum.count > 0 ? sum.translation_percent / sum.count : kNan;
    sum.rotation_deg_per_m = sum.count > 0 ? sum.rotation_deg_per_m / sum.count : kNan;
    errors.push_back(sum);
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
