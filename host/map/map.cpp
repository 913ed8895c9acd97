/// \file map.cpp  Places that are recognised (doc/method.md section 10).
#include "quadedge/map.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "map/place_store.hpp"
#include "map/pose_graph.hpp"
#include "map/saved_places.hpp"
#include "odometry/current_rig.hpp"
#include "odometry/motion_search.hpp"
#include "odometry/odometry_constants.hpp"
#include "pose/rig_uncertainty.hpp"
#include "quadedge/pi.hpp"

namespace quadedge {
namespace {

using map::GraphEdge;

constexpr double kBytesPerMegabyte = 1e6;

/// Largest squared deviation of a closure that the map expects: 99.9 % of chi^2 with six degrees of freedom. With a
/// second closure that agrees, ten times the deviation in standard deviations is possible.
constexpr double kExpected = 22.5, kPossible = 100 * kExpected;

/// Where a frame lies.
struct LocatedFrame {
  std::int64_t stamp_ns = 0;
  int node = -1;  ///< -1: lost
  Eigen::Isometry3d node_from_left = Eigen::Isometry3d::Identity();
};

/// A closure that may still be confirmed by another.
struct PendingClosure {
  std::size_t number;  ///< in the list of closures
  GraphEdge edge;
};

}  // namespace

const char* to_string(ClosureVerdict verdict) {
  switch (verdict) {
    case ClosureVerdict::kept: return "kept";
    case ClosureVerdict::not_found: return "not_found";
    case ClosureVerdict::ambiguous: return "ambiguous";
    case ClosureVerdict::unconfirmed: return "unconfirmed";
  }
  return "unknown";
}

class Map::Implementation {
 public:
  explicit Implementation(StereoOdometry& odometry)
      : odometry_(odometry),
        config_(odometry.config()),
        store_(static_cast<std::size_t>(config_.map.max_memory_mb * kBytesPerMegabyte)),
        graph_(config_.pose),
        search_(config_, odometry.current_rig().frontend, odometry.current_rig().offset) {
    map::check_map_config(config_);
  }

  bool add(const FrameResult& result);
  Trajectory trajectory() const;
  std::optional<Eigen::Isometry3d> pose(std::size_t frame) const;
  SavedMap saved() const;
  int segments() const;
  const Eigen::Isometry3d& map_from_odometry() const { return map_from_odometry_; }
  const std::vector<Closure>& closures() const { return closures_; }
  const map::PlaceStore& store() const { return store_; }

 private:
  void locate(const FrameResult& result);
  int node_of_reference(int frame);
  bool recognise(int node);
  std::optional<GraphEdge> compare(const map::Place& place, int node, Closure& closure);
  bool decide(const GraphEdge& edge);
  bool agree(GraphEdge witness, const GraphEdge& edge) const;
  void keep(const GraphEdge& edge, Closure& closure);
  LocatedFrame& frame(int number) { return frames_[static_cast<std::size_t>(number)]; }
  std::map<int, int> frames_of_segments() const;
  int largest_segment() const;

  StereoOdometry& odometry_;
  Config config_;
  map::PlaceStore store_;
  map::PoseGraph graph_;
  odometry::MotionSearch search_;
  std::vector<LocatedFrame> frames_;
  std::vector<int> frame_of_node_;
  /// Motion of the frame located last, from its node to itself, in case it becomes a reference.
  GraphEdge last_motion_;
  std::vector<Closure> closures_;
  std::vector<PendingClosure> pending_;
  Eigen::Isometry3d map_from_odometry_ = Eigen::Isometry3d::Identity();
};

/// The node of a reference of the odometry. One that is not a node yet becomes one: the last located frame.
int Map::Implementation::node_of_reference(int number) {
  const LocatedFrame& reference = frame(number);
  if (frame_of_node_[static_cast<std::size_t>(reference.node)] == number) return reference.node;
  GraphEdge edge = last_motion_;
  edge.to = graph_.add_node(graph_.pose(reference.node) * reference.node_from_left);
  frame_of_node_.push_back(number);
  graph_.add_edge(edge);
  frame(number) = {reference.stamp_ns, edge.to, Eigen::Isometry3d::Identity()};
  return edge.to;
}

/// Enters the frame tracked last. Key rigs and lost frames with edges become nodes.
void Map::Implementation::locate(const FrameResult& result) {
  const int number = static_cast<int>(frames_.size());
  frames_.push_back({result.stamp_ns});
  const bool has_motion = result.status == FrameStatus::tracked;
  if (has_motion) {
    const int reference = node_of_reference(result.reference_frame);
    last_motion_ = GraphEdge::of(reference, -1, {*result.current_from_reference, *result.relative_covariance},
                                 result.diagnostics.rig_sensitivity, false);
    frame(number).node = reference;
    frame(number).node_from_left = result.current_from_reference->inverse();
    if (result.new_key_rig) node_of_reference(number);
  } else if (result.status != FrameStatus::lost_too_few_edges && result.status != FrameStatus::lost_rig_mismatch) {
    frame(number).node = graph_.add_node(result.pose_or_prediction());
    frame_of_node_.push_back(number);
  }
}

bool Map::Implementation::add(const FrameResult& result) {
  locate(result);
  const LocatedFrame& now = frames_.back();
  if (now.node < 0) return false;
  const bool is_node = frame_of_node_[static_cast<std::size_t>(now.node)] == static_cast<int>(frames_.size()) - 1;
  const bool changed = is_node && recognise(now.node);
  if (result.world_from_left)
    map_from_odometry_ = graph_.pose(now.node) * now.node_from_left * result.world_from_left->inverse();
  return changed;
}

/// Compares the current rig, which is a node, with similar places and keeps it.
bool Map::Implementation::recognise(int node) {
  map::Place place;
  place.rig = odometry_.current_rig().frontend.keep();
  place.signature = map::place_signature(place.rig);
  place.node = node;
  const auto is_candidate = [&](const map::Place& other) {
    return graph_.component(other.node) != graph_.component(node) || node - other.node > config_.map.min_gap;
  };
  bool changed = false;
  for (const auto& similar : store_.most_similar(place.signature, config_.map.candidates, is_candidate)) {
    Closure closure;
    closure.frame = static_cast<int>(frames_.size()) - 1;
    closure.other = similar.place->rig.frame;
    closure.similarity = static_cast<double>(similar.similarity);
    const auto edge = compare(*similar.place, node, closure);
    closures_.push_back(closure);
    if (edge) changed = decide(*edge) || changed;
  }
  store_.add(std::move(place));
  if (changed) graph_.optimise();
  return changed;
}

/// Searches for the motion from a place to the current rig. \returns it, unless it is ambiguous
std::optional<GraphEdge> Map::Implementation::compare(const map::Place& place, int node, Closure& closure) {
  const odometry::CurrentRig now = odometry_.current_rig();
  odometry::MotionQuery query;
  query.current = now.rig;
  query.base = now.frontend.restore(place.rig);
  query.seed = config_.seed + static_cast<std::uint64_t>(closure.frame);
  const odometry::StepHandle step = search_.find(query);
  if (!step->ok()) return std::nullopt;
  const pose::MotionEstimate& motion = step->motion;
  closure.frame_from_other = motion.current_from_previous;
  closure.inliers = motion.inliers;
  closure.support = step->verdict.support;
  closure.verdict = step->doubt.exists() ? ClosureVerdict::ambiguous : ClosureVerdict::unconfirmed;
  GraphEdge edge =
      GraphEdge::of(place.node, node, {motion.current_from_previous, motion.covariance},
                    pose::rig_sensitivity(motion.current_from_previous.inverse(), step->mean_inverse_depth()), true);
  if (graph_.component(place.node) == graph_.component(node)) {
    const Eigen::Isometry3d before = graph_.pose(node).inverse() * graph_.pose(place.node);
    const Eigen::Isometry3d error = motion.current_from_previous * before.inverse();
    closure.deviation = std::sqrt(graph_.deviation(graph_.motion(edge.from, edge.to), edge));
    closure.distance_m = error.translation().norm();
    closure.angle_deg = Eigen::AngleAxisd(error.linear()).angle() / kDegree;
  }
  if (step->doubt.exists()) return std::nullopt;
  return edge;
}

/// Whether the loop of both closures and the map's motions between their ends closes.
bool Map::Implementation::agree(GraphEdge witness, const GraphEdge& edge) const {
  const auto is_joined = [&](int one, int other) { return graph_.component(one) == graph_.component(other); };
  if (!is_joined(witness.from, edge.from)) witness = witness.reversed();
  if (!is_joined(witness.from, edge.from) || !is_joined(witness.to, edge.to)) return false;
  const GraphEdge around = graph_.motion(witness.to, edge.to).after(witness).after(graph_.motion(edge.from, witness.from));
  return graph_.deviation(around, edge) < kExpected;
}

void Map::Implementation::keep(const GraphEdge& edge, Closure& closure) {
  graph_.add_edge(edge);
  closure.verdict = ClosureVerdict::kept;
}

/// Keeps the closure listed last if the map expects it, or if it agrees with another that the map does not expect.
bool Map::Implementation::decide(const GraphEdge& edge) {
  const bool has_prior = graph_.component(edge.from) == graph_.component(edge.to);
  const double deviation = has_prior ? graph_.deviation(graph_.motion(edge.from, edge.to), edge) : 0;
  if (deviation > kPossible) return false;
  // To join two segments, support that a wrong motion does not reach by chance suffices.
  if (has_prior ? deviation < kExpected : closures_.back().support > odometry::kChanceSupport) {
    keep(edge, closures_.back());
    return true;
  }
  for (auto witness = pending_.begin(); witness != pending_.end(); ++witness) {
    if (!agree(witness->edge, edge)) continue;
    keep(witness->edge, closures_[witness->number]);
    keep(edge, closures_.back());
    pending_.erase(witness);
    return true;
  }
  pending_.push_back({closures_.size() - 1, edge});
  return false;
}

std::map<int, int> Map::Implementation::frames_of_segments() const {
  std::map<int, int> counts;
  for (const LocatedFrame& located : frames_)
    if (located.node >= 0) ++counts[graph_.component(located.node)];
  return counts;
}

int Map::Implementation::segments() const {
  const auto counts = frames_of_segments();
  return static_cast<int>(std::count_if(counts.begin(), counts.end(), [](const auto& one) { return one.second > 1; }));
}

/// The component with the largest number of frames; -1 without frames.
int Map::Implementation::largest_segment() const {
  const auto counts = frames_of_segments();
  const auto largest =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return largest == counts.end() ? -1 : largest->first;
}

Trajectory Map::Implementation::trajectory() const {
  Trajectory trajectory;
  const int largest = largest_segment();
  for (const LocatedFrame& located : frames_)
    if (located.node >= 0 && graph_.component(located.node) == largest)
      trajectory.push_back({located.stamp_ns, graph_.pose(located.node) * located.node_from_left});
  return trajectory;
}

std::optional<Eigen::Isometry3d> Map::Implementation::pose(std::size_t frame) const {
  const LocatedFrame& located = frames_.at(frame);
  if (located.node < 0 || graph_.component(located.node) != largest_segment()) return std::nullopt;
  return graph_.pose(located.node) * located.node_from_left;
}

SavedMap Map::Implementation::saved() const {
  map::SavedPlaces saved;
  saved.rig = odometry::with_disparity_offset(odometry_.rig(), 0);
  const odometry::DisparityOffset& offset = odometry_.current_rig().offset;
  saved.offset = offset.value();
  saved.offset_variance = offset.variance();
  saved.settings = map::descriptor_settings(config_);
  std::vector<map::Place> places;
  const int largest = largest_segment();
  for (const map::Place& place : store_.places()) {
    if (graph_.component(place.node) != largest) continue;
    places.push_back(place);
    saved.poses.push_back(graph_.pose(place.node));
  }
  return {std::move(saved), std::move(places)};
}

Map::Map(StereoOdometry& odometry) : implementation_(std::make_unique<Implementation>(odometry)) {}
Map::~Map() = default;
bool Map::add(const FrameResult& result) { return implementation_->add(result); }
const Eigen::Isometry3d& Map::map_from_odometry() const { return implementation_->map_from_odometry(); }
Trajectory Map::trajectory() const { return implementation_->trajectory(); }
std::optional<Eigen::Isometry3d> Map::pose(int frame) const {
  return implementation_->pose(static_cast<std::size_t>(frame));
}
SavedMap Map::saved() const { return implementation_->saved(); }
int Map::segments() const { return implementation_->segments(); }
const std::vector<Closure>& Map::closures() const { return implementation_->closures(); }
std::size_t Map::key_rigs() const { return implementation_->store().size(); }
std::size_t Map::bytes() const { return implementation_->store().bytes(); }

}  // namespace quadedge
