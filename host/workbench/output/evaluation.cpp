/// \file evaluation.cpp  Absolute and relative pose errors with the definitions of evo (github.com/MichaelGrupp/evo):
/// E = reference^-1 estimate; translation part |t(E)|, rotation part the angle of R(E); RPE compares consecutive steps.

#include "quadedge/evaluation.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/numeric.hpp"
#include "common/printed.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"

namespace quadedge {
namespace {

using Pose = Eigen::Isometry3d;

/// A pose and its ground truth.
struct MatchedPoses {
  std::int64_t stamp_ns;
  Eigen::Isometry3d estimate, truth;
  int segment;
};

/// Of all errors that have a value; NaN if none has.
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

/// Angle of a rotation [deg], accurate near 0 and 180 degrees, unlike the arc cosine of the trace.
double angle_deg(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q(rotation);
  return 2 * std::atan2(q.vec().norm(), std::abs(q.w())) * kDegreesPerRadian;
}

constexpr std::size_t kStartStep = 10;  // poses from one start of a sub-path to the next

/// Length of the true path up to each pose [m].
std::vector<double> distances(const std::vector<MatchedPoses>& poses) {
  std::vector<double> sums = {0};
  for (std::size_t i = 1; i < poses.size(); ++i)
    sums.push_back(sums.back() + (poses[i].truth.translation() - poses[i - 1].truth.translation()).norm());
  return sums;
}

/// t_rel and r_rel over sub-paths, what their ends are off, seen from their starts, as KITTI's odometry devkit defines
/// them. One entry per length [m], with `count` 0 and errors NaN where the path is too short.
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

/// The mean over the sub-paths of all lengths.
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

/// Nearest truth pose for each estimated pose, both in increasing order and each used at most once: by the nearest pose
/// of an estimate that is denser. Where a segment of the estimate goes back in time, the search starts anew.
std::vector<MatchedPoses> match_by_stamp(const Trajectory& estimate, const Trajectory& truth,
                                         std::int64_t tolerance_ns) {
  std::vector<MatchedPoses> matches;
  std::size_t next = 0;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const StampedPose& pose = estimate[i];
    if (i > 0 && pose.stamp_ns < estimate[i - 1].stamp_ns) next = 0;
    const auto distance = [&](std::size_t row, std::size_t of) {
      return std::abs(truth[row].stamp_ns - estimate[of].stamp_ns);
    };
    while (next + 1 < truth.size() && distance(next + 1, i) <= distance(next, i)) ++next;
    if (next >= truth.size() || distance(next, i) > tolerance_ns) continue;
    if (i + 1 < estimate.size() && distance(next, i + 1) < distance(next, i) &&
        (next + 1 == truth.size() || distance(next, i + 1) < distance(next + 1, i + 1)))
      continue;
    matches.push_back({pose.stamp_ns, pose.world_from_left, truth[next].world_from_left, pose.segment});
    ++next;
  }
  return matches;
}

/// The four errors of every matched pose after the estimate is transformed by `world_from_estimate`; RPE is NaN for the
/// first pose of a segment.
struct Errors {
  std::vector<double> ape_rotation, ape_translation, rpe_rotation, rpe_translation;

  Errors(const std::vector<MatchedPoses>& matches, const Pose& world_from_estimate) {
    Pose previous;
    for (std::size_t i = 0; i < matches.size(); ++i) {
      const Pose estimate = world_from_estimate * matches[i].estimate;
      const Pose ape = matches[i].truth.inverse() * estimate;
      ape_rotation.push_back(angle_deg(ape.linear()));
      ape_translation.push_back((estimate.translation() - matches[i].truth.translation()).norm());
      if (i == 0 || matches[i].segment != matches[i - 1].segment) {
        rpe_rotation.push_back(kNan);
        rpe_translation.push_back(kNan);
      } else {
        const Pose truth_step = matches[i - 1].truth.inverse() * matches[i].truth;
        const Pose rpe = truth_step.inverse() * (previous.inverse() * estimate);
        rpe_rotation.push_back(angle_deg(rpe.linear()));
        rpe_translation.push_back(rpe.translation().norm());
      }
      previous = estimate;
    }
  }

  PoseErrors summary() const {
    return {statistics(ape_rotation), statistics(ape_translation), statistics(rpe_rotation),
            statistics(rpe_translation)};
  }
};

/// Umeyama's alignment of the positions without scale; nothing if they lie on a line, which leaves the rotation
/// undetermined.
std::optional<Pose> se3_alignment(const std::vector<MatchedPoses>& matches) {
  const auto count = static_cast<Eigen::Index>(matches.size());
  Eigen::Matrix3Xd from(3, count), to(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    from.col(i) = matches[static_cast<std::size_t>(i)].estimate.translation();
    to.col(i) = matches[static_cast<std::size_t>(i)].truth.translation();
  }
  const Eigen::Matrix3d covariance = (to.colwise() - to.rowwise().mean()) *
                                     (from.colwise() - from.rowwise().mean()).transpose() / static_cast<double>(count);
  const Eigen::Vector3d spread = Eigen::JacobiSVD<Eigen::Matrix3d>(covariance).singularValues();
  // As in evo: two of the three spreads must exceed the rounding error of a double.
  if (spread[1] <= std::numeric_limits<double>::epsilon()) return std::nullopt;
  Pose alignment;
  alignment.matrix() = Eigen::umeyama(from, to, false);
  return alignment;
}

/// "25.3 mm" or "1.27 m".
std::string length_text(double metres) {
  return metres < 0.1 ? printed("%.3g mm", 1000 * metres) : printed("%.3g m", metres);
}

/// Explains why the rotation of the alignment is undetermined; empty if it is determined. The second of the three root
/// mean square extents measures the extent of the positions off the main direction of the path; errors of a quarter of
/// it rotate the alignment by about 14 degrees. If the estimate itself is rotated by more than that
/// (`rotation_error_deg`, root mean square, origin-aligned), its rotation errors are meaningful all the same.
std::string open_rotation(const std::vector<MatchedPoses>& matches, double residual, double rotation_error_deg) {
  constexpr double kLargestRatio = 0.25;
  if (rotation_error_deg > std::atan(kLargestRatio) * kDegreesPerRadian) return {};
  const auto count = static_cast<Eigen::Index>(matches.size());
  Eigen::Matrix3Xd truth(3, count);
  for (Eigen::Index i = 0; i < count; ++i) truth.col(i) = matches[static_cast<std::size_t>(i)].truth.translation();
  truth.colwise() -= truth.rowwise().mean().eval();
  const Eigen::Vector3d extents =
      Eigen::JacobiSVD<Eigen::Matrix3d>(truth * truth.transpose() / static_cast<double>(count)).singularValues();
  const double along = std::sqrt(extents[0]), across = std::sqrt(extents[1]);
  if (residual <= kLargestRatio * across) return {};
  const bool still = residual > kLargestRatio * along;
  return "the positions extend " + length_text(still ? along : across) +
         (still ? " around one point" : " around a straight line") + ", and differ by " + length_text(residual) +
         " after alignment (root mean squares), so that the rotation is undetermined";
}

PoseErrors undefined() {
  const ErrorStatistics nothing{kNan, kNan, kNan, kNan};
  return {nothing, nothing, nothing, nothing};
}

std::string stamp_range(const Trajectory& trajectory) {
  if (trajectory.empty()) return "none";
  return data::counted(trajectory.size(), "pose") + " from " + data::format_seconds(trajectory.front().stamp_ns) +
         " to " + data::format_seconds(trajectory.back().stamp_ns) + " s";
}

/// The errors of at least two poses. \param lengths of the sub-paths [m]
TrajectoryEvaluation evaluate(const std::vector<MatchedPoses>& matches, const std::vector<double>& lengths) {
  TrajectoryEvaluation evaluation;
  evaluation.matched = static_cast<int>(matches.size());
  evaluation.segment = matches[0].segment;
  const Errors origin(matches, matches[0].truth * matches[0].estimate.inverse());
  evaluation.origin_aligned = origin.summary();
  const auto alignment = se3_alignment(matches);
  evaluation.se3_aligned = alignment ? Errors(matches, *alignment).summary() : undefined();
  evaluation.se3_open_rotation =
      alignment ? open_rotation(matches, evaluation.se3_aligned.ape_translation_m.rmse,
                                evaluation.origin_aligned.ape_rotation_deg.rmse)
                : std::string("the positions lie on a straight line, so that the rotation is undetermined");
  if (!evaluation.se3_open_rotation.empty()) evaluation.se3_aligned.ape_rotation_deg = {kNan, kNan, kNan, kNan};
  std::vector<std::int64_t> steps_ns;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (i > 0) evaluation.path_length_m += (matches[i].truth.translation() - matches[i - 1].truth.translation()).norm();
    if (!std::isnan(origin.rpe_rotation[i])) steps_ns.push_back(matches[i].stamp_ns - matches[i - 1].stamp_ns);
    evaluation.per_pose.push_back({matches[i].stamp_ns, origin.ape_rotation[i], origin.ape_translation[i],
                                   origin.rpe_rotation[i], origin.rpe_translation[i]});
  }
  evaluation.rpe_steps = static_cast<int>(steps_ns.size());
  if (!steps_ns.empty()) evaluation.rpe_interval_s = 1e-9 * static_cast<double>(upper_median(steps_ns));
  evaluation.sub_paths = sub_path_errors(matches, lengths);
  evaluation.sub_path_mean = mean_of(evaluation.sub_paths);
  if (evaluation.path_length_m > 0) {
    evaluation.end_drift_percent = 100 * origin.ape_translation.back() / evaluation.path_length_m;
  }
  return evaluation;
}

/// Every segment by itself; nothing if there is only one.
std::vector<TrajectoryEvaluation> evaluate_segments(const std::vector<MatchedPoses>& matches,
                                                    const std::vector<double>& lengths) {
  std::vector<TrajectoryEvaluation> segments;
  if (matches.front().segment == matches.back().segment) return segments;
  for (auto begin = matches.begin(); begin != matches.end();) {
    const auto end =
        std::find_if(begin, matches.end(), [&](const MatchedPoses& match) { return match.segment != begin->segment; });
    TrajectoryEvaluation single;
    single.matched = 1;
    single.segment = begin->segment;
    single.origin_aligned = single.se3_aligned = undefined();
    single.se3_open_rotation = "a single pose";
    segments.push_back(end - begin > 1 ? evaluate({begin, end}, lengths) : single);
    begin = end;
  }
  return segments;
}

}  // namespace

TrajectoryEvaluation evaluate_trajectory(const Trajectory& estimate, const Trajectory& truth, int from_frame,
                                         std::int64_t max_stamp_difference_ns, const std::vector<double>& lengths) {
  for (const double length : lengths)
    if (!(length > 0 && std::isfinite(length))) throw UsageError("length of sub-paths: expected metres, more than 0");
  check_trajectory(estimate, "estimate");
  check_trajectory(truth, "truth");
  const std::size_t first = std::min(static_cast<std::size_t>(std::max(0, from_frame)), estimate.size());
  const Trajectory kept(estimate.begin() + static_cast<std::ptrdiff_t>(first), estimate.end());
  const auto matches = match_by_stamp(kept, truth, max_stamp_difference_ns);
  if (matches.size() < 2) {
    throw DataError("trajectories: found " + data::counted(matches.size(), "pose") + " whose timestamps agree within " +
                    data::format_seconds(max_stamp_difference_ns) + " s, expected at least 2; estimate: " +
                    stamp_range(kept) + " (from frame " + std::to_string(first) + "), truth: " + stamp_range(truth));
  }
  TrajectoryEvaluation evaluation = evaluate(matches, lengths);
  evaluation.estimate_poses = static_cast<int>(estimate.size());
  evaluation.truth_poses = static_cast<int>(truth.size());
  evaluation.segments = evaluate_segments(matches, lengths);
  return evaluation;
}

}  // namespace quadedge
