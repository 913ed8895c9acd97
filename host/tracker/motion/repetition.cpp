/// \file repetition.cpp  Edges vote for the shifts that bring them onto others; what only one motion finds decides.
#include "motion/repetition.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/oriented_point.hpp"

namespace quadedge::odometry {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using pose::StereoMeasurement;

/// Edges that vote, the faster half of which tells shifts apart, and shifts to either side: steps by which those move
/// this far [px]. Nearer than kNeighbours steps, an equal is a neighbour. Of a motion by less than a quarter of a step
/// the direction is unknown.
constexpr std::size_t kVoters = 250;
constexpr int kShifts = 64, kNeighbours = 3;
constexpr double kShiftStep = 4, kLeastMotion = 0.25;
/// An equal lies this close to the line of motion, and in disparity [px], with a direction of this cosine to that of
/// the edge.
constexpr double kEqualDistance = 1.5, kEqualCosine = 0.966;
/// The scene repeats if this fraction of the voters in view have equals, more than by chance (below 0.2), as equals may
/// be shared by two steps; at least half of them count as in view. The nearest shift that nearly as many have as the
/// most frequent one is the period.
constexpr double kRepeatingRatio = 0.25, kLeastInView = 0.5, kNearlyMost = 0.8;
/// Motions differ by periods if this fraction of one is left.
constexpr double kPeriodRest = 0.15;
/// Border of the image in which partners in the other one may be out of view [image width].
constexpr double kBorder = 0.06;
/// Sine of the angle to the line of motion from which an edge tells the place along it.
constexpr double kAcross = 0.5;
/// An edge decides if its distance changes by at most this fraction, and the motions differ by so much there [px].
constexpr double kSameSize = 0.075, kLeastShift = 8;
/// Similarity of an edge that is found again.
constexpr float kSimilar = 0.7F;
/// Edges that only one motion finds show that it is the camera's if they are so many times those of the other, more
/// than that, and this fraction of what both find.
constexpr double kDecisiveRatio = 2, kDecisiveEdges = 20, kDecisiveShare = 0.5;

Vector3d point_of(const StereoMeasurement& edge) { return edge.ray / edge.inverse_depth; }

/// Displacement of a ray by a shift, times its depth.
Vector2d line_of(const Vector3d& ray, const Vector3d& shift) { return shift.head<2>() - shift.z() * ray.head<2>(); }

/// Displacement of an edge by a shift [px]; 0 for one along the line of motion.
double speed_of(const PinholeCamera& camera, const StereoMeasurement& edge, const Vector3d& shift) {
  const Vector2d line = line_of(edge.ray, shift), along = edge.left_edge.cast<double>();
  const double across = line.x() * along.y() - line.y() * along.x();
  return std::abs(across) > kAcross * line.norm() ? camera.fx * line.norm() * edge.inverse_depth : 0;
}

/// Shift that brings the first edge onto the second one [m]; 0 if none does.
double shift_between(double focal, const StereoMeasurement& from, const StereoMeasurement& to, const Vector3d& along) {
  if (from.left_edge.dot(to.left_edge) < static_cast<float>(kEqualCosine)) return 0;
  const Vector3d point = point_of(from);
  const Vector2d line = line_of(to.ray, along), offset = point.z() * to.ray.head<2>() - point.head<2>();
  const double shift = line.dot(offset) / line.squaredNorm(), depth = point.z() + shift * along.z();
  if (!(depth > 0) || focal * (offset - shift * line).norm() > kEqualDistance * depth) return 0;
  return std::abs(to.inverse_depth - 1 / depth) <= kEqualDistance * to.inverse_depth_per_pixel ? shift : 0;
}

/// Whether a point is in view, and so far from the border that its stereo edge is found.
bool is_in_view(const PinholeCamera& camera, const Vector3d& point) {
  if (!(point.z() > 0)) return false;
  const Vector2d pixel = camera.project(point);
  const double margin = kBorder * camera.width;
  return pixel.x() > margin && pixel.y() > margin && pixel.x() < camera.width - margin &&
         pixel.y() < camera.height - margin;
}

}  // namespace

double period_along(const PinholeCamera& camera, const pose::MeasuredEdges& measured, const MotionStep& step) {
  const Vector3d motion = step.motion.learned.current_from_previous.translation(), along = motion.normalized();
  std::vector<std::pair<double, const StereoMeasurement*>> voters;
  for (std::size_t q = 0; q < step.quads.size(); ++q) {
    const auto row = static_cast<std::size_t>(step.quads.match[q]);
    const auto& edge = measured[static_cast<std::size_t>(step.matches.current[row])];
    const double speed = step.motion.inlier[q] != 0 && edge ? speed_of(camera, *edge, along) : 0;
    if (speed > 0) voters.emplace_back(speed, &*edge);
  }
  const auto faster = [](const auto& a, const auto& b) { return a.first > b.first; };
  std::stable_sort(voters.begin(), voters.end(), faster);
  voters.resize(voters.size() / 2);
  if (static_cast<double>(voters.size()) < kDecisiveEdges) return 0;
  const double unit = kShiftStep / voters.back().first;
  if (motion.norm() < kLeastMotion * unit) return 0;
  struct Shift {
    double in_view = 0, votes = 0, sum = 0;
    const StereoMeasurement* last = nullptr;
    double count = 0;
    double ratio() const { return votes / std::max({in_view, kLeastInView * count, 1.0}); }
  };
  std::vector<Shift> shifts(2 * kShifts + 3);  // with one more at both ends
  const auto at = [&](int k) -> Shift& { return shifts[static_cast<std::size_t>(k + kShifts + 1)]; };
  for (std::size_t v = 0; v < voters.size(); v += 1 + voters.size() / kVoters) {
    const StereoMeasurement& voter = *voters[v].second;
    for (int k = -kShifts; k <= kShifts; ++k) {
      at(k).count += 1;
      at(k).in_view += is_in_view(camera, point_of(voter) + k * unit * along) ? 1 : 0;
    }
    for (const auto& other : measured) {
      const double shift = other ? shift_between(camera.fx, voter, *other, along) : 0;
      const auto k = static_cast<int>(std::lround(std::clamp(shift / unit, -1.0 * kShifts - 1, kShifts + 1.0)));
      if (std::abs(k) < kNeighbours || std::abs(k) > kShifts || std::exchange(at(k).last, &voter) == &voter) continue;
      at(k).votes += 1;
      at(k).sum += shift;
    }
  }
  double most = kRepeatingRatio / kNearlyMost;
  for (const Shift& shift : shifts) most = std::max(most, shift.ratio());
  for (int distance = kNeighbours; distance <= kShifts; ++distance)
    for (const int k : {distance, -distance}) {
      const double ratio = at(k).ratio();
      if (ratio >= kNearlyMost * most && ratio >= at(k - 1).ratio() && !(at(k + 1).ratio() > ratio))
        return at(k).sum / at(k).votes;
    }
  return 0;
}

bool differs_by_periods(const MotionStep& step, const Isometry3d& other, double period) {
  const Vector3d motion = step.motion.current_from_previous.translation(), shift = other.translation() - motion;
  const double periods = std::round(shift.dot(motion.normalized()) / period);
  return periods != 0 && (shift - periods * period * motion.normalized()).norm() < kPeriodRest * std::abs(period);
}

bool SharedEdges::tell_for(double one, double other) const {
  return one > kDecisiveRatio * other + kDecisiveEdges && one > kDecisiveShare * both;
}

SharedEdges compare_shifted(const PinholeCamera& camera, const pose::MeasuredEdges& measured,
                            const MatchedMotion& first, const MatchedMotion& second) {
  std::vector<std::uint8_t> finds(measured.size(), 0);
  const auto mark = [&](const TemporalMatches& matches, std::uint8_t bit) {
    for (std::size_t i = 0; i < matches.size(); ++i)
      if (matches.ncc[i] > kSimilar) finds[static_cast<std::size_t>(matches.current[i])] |= bit;
  };
  mark(first.matches, 1);
  mark(second.matches, 2);
  const Isometry3d &one = first.current_from_base, &other = second.current_from_base;
  const Vector3d shift = one.translation() - other.translation();
  const double approach = std::max(std::abs(one.translation().z()), std::abs(other.translation().z()));
  const Isometry3d back_by_one = one.inverse(), back_by_other = other.inverse();
  SharedEdges shared;
  for (std::size_t i = 0; i < finds.size(); ++i) {
    if (finds[i] == 0 || !measured[i]) continue;
    if (approach * measured[i]->inverse_depth > kSameSize || speed_of(camera, *measured[i], shift) < kLeastShift)
      continue;
    const Vector3d point = point_of(*measured[i]);
    if (!is_in_view(camera, back_by_one * point) || !is_in_view(camera, back_by_other * point)) continue;
    (finds[i] == 3 ? shared.both : finds[i] == 1 ? shared.first : shared.second) += 1;
  }
  return shared;
}

}  // namespace quadedge::odometry
