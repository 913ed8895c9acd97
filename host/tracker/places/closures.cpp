/// \file closures.cpp  A closure is kept if the map expects it, or if a second one agrees.
#include "places/closures.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/uncertain_pose.hpp"
#include "motion/motion_step.hpp"
#include "motion/odometry_constants.hpp"
#include "motion/view_change.hpp"
#include "quadedge/camera.hpp"

namespace quadedge {

const char* to_string(ClosureVerdict verdict) {
  switch (verdict) {
    case ClosureVerdict::kept: return "kept";
    case ClosureVerdict::not_found: return "not_found";
    case ClosureVerdict::ambiguous: return "ambiguous";
    case ClosureVerdict::unconfirmed: return "unconfirmed";
  }
  return "unknown";
}

namespace places {
namespace {

/// Largest squared deviation of a closure that the map expects: 99.9 % of chi^2 with six degrees of freedom. With a
/// second closure that agrees, ten times the deviation in standard deviations is possible.
constexpr double kExpected = 22.5, kPossible = 100 * kExpected;

/// Number of closures that wait for another that agrees. One is found in the frames that follow, or not at all.
constexpr std::size_t kMostPending = 20;

}  // namespace

/// Whether its support, which a wrong motion does not reach by chance, suffices to join two segments.
bool Closures::is_certain(const ListedClosure& closure) const {
  return all_[closure.number].support > odometry::kChanceSupport;
}

std::optional<ListedClosure> Closures::list(const Closure& compared, int place, int node,
                                            const odometry::MotionStep& step) {
  Closure& closure = all_.emplace_back(compared);
  if (!step.ok()) return std::nullopt;
  const pose::MotionEstimate& motion = step.motion;
  const pose::RelativePose frame_from_other = motion.adopted();
  closure.frame_from_other = frame_from_other.transform;
  closure.inliers = motion.inliers;
  closure.support = step.verdict.support;
  closure.verdict = step.verdict.ambiguity.exists() ? ClosureVerdict::ambiguous : ClosureVerdict::unconfirmed;
  const Eigen::Isometry3d other_from_frame = frame_from_other.transform.inverse();
  RigSensitivity by_rig = pose::rig_sensitivity(other_from_frame, step.mean_inverse_depth());
  by_rig.rightCols<1>() = pose::offset_sensitivity(other_from_frame, motion.learned.by_offset);
  GraphEdge edge = GraphEdge::of(place, node, frame_from_other, by_rig, true);
  if (graph_.is_joined(edge.from, edge.to)) {
    const Eigen::Isometry3d before = graph_.pose(edge.to).inverse() * graph_.pose(edge.from);
    const Eigen::Isometry3d error = frame_from_other.transform * before.inverse();
    closure.deviation = std::sqrt(graph_.deviation(graph_.motion(edge.from, edge.to), edge));
    closure.distance_m = error.translation().norm();
    closure.angle_deg = Eigen::AngleAxisd(error.linear()).angle() / kDegree;
  }
  return ListedClosure{all_.size() - 1, std::move(edge)};
}

/// Whether the loop of both closures and the map's motions between their ends closes.
bool Closures::agree(GraphEdge confirming, const GraphEdge& edge) const {
  if (!graph_.is_joined(confirming.from, edge.from)) confirming = confirming.reversed();
  if (!graph_.is_joined(confirming.from, edge.from) || !graph_.is_joined(confirming.to, edge.to)) return false;
  const GraphEdge around =
      graph_.motion(confirming.to, edge.to).after(confirming).after(graph_.motion(edge.from, confirming.from));
  return graph_.deviation(around, edge) < kExpected;
}

bool Closures::is_rival(int place, const std::vector<ListedClosure>& joining, double inverse_depth) const {
  return std::any_of(joining.begin(), joining.end(), [&](const ListedClosure& closure) {
    const GraphEdge& edge = closure.edge;
    if (!is_certain(closure) || !graph_.is_joined(place, edge.from)) return false;
    const Eigen::Isometry3d map_from_now = graph_.pose(edge.from) * edge.measured.transform.inverse();
    return odometry::view_change(map_from_now.inverse() * graph_.pose(place), inverse_depth) > odometry::kSameView;
  });
}

void Closures::reject_contradictions(const std::vector<ListedClosure>& joining) {
  for (const ListedClosure& one : joining) {
    for (const ListedClosure& other : joining) {
      if (!is_certain(one) || !is_certain(other) || !graph_.is_joined(one.edge.from, other.edge.from)) continue;
      if (!agree(one.edge, other.edge)) listed(one).verdict = listed(other).verdict = ClosureVerdict::ambiguous;
    }
  }
}

void Closures::keep(const ListedClosure& closure) {
  graph_.add_edge(closure.edge);
  listed(closure).verdict = ClosureVerdict::kept;
}

bool Closures::decide(const ListedClosure& closure) {
  if (listed(closure).verdict == ClosureVerdict::ambiguous) return false;
  const GraphEdge& edge = closure.edge;
  const bool has_prior = graph_.is_joined(edge.from, edge.to);
  const double deviation = has_prior ? graph_.deviation(graph_.motion(edge.from, edge.to), edge) : 0;
  if (deviation > kPossible) return false;
  if (has_prior ? deviation >= kExpected : !is_certain(closure)) {
    const auto confirming = std::find_if(pending_.begin(), pending_.end(),
                                         [&](const ListedClosure& other) { return agree(other.edge, edge); });
    if (confirming == pending_.end()) {
      pending_.push_back(closure);
      if (pending_.size() > kMostPending) pending_.pop_front();
      return false;
    }
    keep(*confirming);
    pending_.erase(confirming);
  }
  keep(closure);
  graph_.optimise();
  return true;
}

}  // namespace places
}  // namespace quadedge
