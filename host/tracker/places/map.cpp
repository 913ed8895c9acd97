/// \file map.cpp  Places that are recognised (doc/method.md section 10).
#include "quadedge/map.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <utility>

#include "common/matching_constants.hpp"
#include "geometry/corrected_rig.hpp"
#include "geometry/uncertain_pose.hpp"
#include "motion/latest_frame.hpp"
#include "motion/motion_search.hpp"
#include "motion/odometry_constants.hpp"
#include "motion/view_change.hpp"
#include "places/closures.hpp"
#include "places/place_store.hpp"
#include "places/pose_graph.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/error.hpp"

namespace quadedge {
namespace {

using places::GraphEdge;

constexpr double kBytesPerMegabyte = 1e6;

/// Standard deviations of the map's prediction that a search near it has to cover; otherwise all edges are matched.
constexpr double kCovered = 3;

/// Two places of a segment may share a part of their views if these, by the map, differ by less than this [rad].
constexpr double kMostChange = 1;

/// A closure within a segment is worth its search if the map's motion has this many times the variance of a motion
/// since the keyframe. A closure has about four times that variance, since a kept frame has a fraction of the edges.
constexpr double kWorthwhile = 12;

/// A node is not kept as a place if its view differs by less than this from that of one of the latest places [rad].
constexpr double kNewView = 0.15;

/// A frame takes one step of a search for a place, and one more for every kNodesPerStep nodes that wait. Beyond
/// kMostWaiting, the oldest is finished at once, since each holds all edges of its frame.
constexpr std::size_t kNodesPerStep = 2, kMostWaiting = 12;

/// About as many edges of a frame take part in global searches for places as a place has.
Config for_places(Config config) {
  config.temporal.global_edges = std::min(config.temporal.global_edges, static_cast<int>(frontend::kKeptEdges / 2));
  return config;
}

/// Where a frame lies.
struct LocatedFrame {
  std::int64_t stamp_ns = 0;
  int node = -1;  ///< -1: lost
  Eigen::Isometry3d node_from_left = Eigen::Isometry3d::Identity();
  GraphEdge motion;  ///< from its node to itself, in case it becomes a reference
};

/// A node with its edges.
struct NodeView {
  int node = 0, frame = 0;
  frontend::FrameEdgesHandle edges;
  double inverse_depth = 0;  ///< mean of the edges [1/m]
  double variance = 0;       ///< trace of the covariance of the motion measured last
};

/// A comparison with a place.
struct Comparison {
  Closure closure;
  int place;    ///< its node
  bool is_own;  ///< whether it is in the same segment
  odometry::MotionSearch::State search;
};

/// A node that is being compared with similar places.
struct WaitingNode {
  struct Candidate {
    int place;  ///< its node
    float similarity;
  };
  NodeView view;
  std::vector<Candidate> candidates;  ///< best first
  std::size_t next = 0;               ///< the next candidate
  std::optional<Comparison> comparison;
  bool is_own_compared = false;                ///< a place of the same segment
  std::optional<places::ListedClosure> own;    ///< with that place
  std::vector<places::ListedClosure> joining;  ///< with places of other segments
};

/// \throws UsageError for the paper's method, which keeps no frames.
StereoOdometry& with_kept_rigs(StereoOdometry& odometry) {
  if (odometry.config().is_paper())
    throw UsageError("the paper's method has no map: choose another preset for --loops");
  return odometry;
}

}  // namespace

class Map::Implementation {
 public:
  explicit Implementation(StereoOdometry& odometry)
      : odometry_(odometry),
        config_(odometry.config()),
        store_(static_cast<std::size_t>(config_.map.max_memory_mb * kBytesPerMegabyte)),
        graph_(config_.pose),
        search_(for_places(config_), odometry::LatestFrame::of(odometry).frontend, odometry.rig()),
        closures_(graph_) {
    places::check_map_config(config_);
    if (const auto& latest = odometry::LatestFrame::of(odometry).frame_edges)
      throw UsageError("a map has to see every frame, and the odometry has tracked " +
                       std::to_string(latest->frame + 1) + "; expected a map made before the first one");
  }

  bool add(const FrameResult& result);
  bool finish();
  Trajectory trajectory() const;
  std::optional<Eigen::Isometry3d> pose(std::size_t frame) const;
  SavedMap saved() const;
  int segments() const;
  const Device& device() const { return odometry::LatestFrame::of(odometry_).device; }
  const Eigen::Isometry3d& map_from_odometry() const { return map_from_odometry_; }
  const std::vector<Closure>& closures() const { return closures_.all(); }
  const places::PlaceStore& store() const { return store_; }

 private:
  void check_is_next() const;
  void locate(const FrameResult& result);
  int node_of_reference(int frame);
  bool recognise(int node);
  bool advance();
  std::optional<Comparison> begin_next(WaitingNode& waiting);
  bool decide_all(const WaitingNode& waiting);
  const places::Place* nearest(int node, int max_gap, int min_gap, double most_change, double inverse_depth) const;
  double mean_inverse_depth() const;
  double spread(const GraphEdge& motion, double inverse_depth) const;
  bool may_overlap(const GraphEdge& motion, double inverse_depth) const;
  bool is_predictable(const GraphEdge& motion, double inverse_depth) const;
  bool is_worthwhile(const GraphEdge& motion, const NodeView& view) const;
  Comparison begin(const NodeView& view, const places::Place& place, float similarity, bool near_prediction);
  std::optional<places::ListedClosure> list(const Comparison& comparison, const NodeView& view) {
    return closures_.list(comparison.closure, comparison.place, view.node, *comparison.search.found);
  }
  LocatedFrame& frame(int number) { return frames_[static_cast<std::size_t>(number)]; }
  std::map<int, int> frames_of_segments() const;
  int largest_segment() const;

  StereoOdometry& odometry_;
  Config config_;
  places::PlaceStore store_;
  places::PoseGraph graph_;
  odometry::MotionSearch search_;
  std::vector<LocatedFrame> frames_;
  std::vector<int> frame_of_node_;
  GraphEdge last_motion_;  ///< of the frame located last
  places::Closures closures_;
  std::deque<WaitingNode> waiting_;  ///< oldest first
  Eigen::Isometry3d map_from_odometry_ = Eigen::Isometry3d::Identity();
};

/// The node of a reference of the odometry. One that is not a node yet becomes one.
int Map::Implementation::node_of_reference(int number) {
  const LocatedFrame& reference = frame(number);
  if (frame_of_node_[static_cast<std::size_t>(reference.node)] == number) return reference.node;
  GraphEdge edge = reference.motion;
  edge.to = graph_.add_node(graph_.pose(reference.node) * reference.node_from_left);
  frame_of_node_.push_back(number);
  graph_.add_edge(edge);
  frame(number) = {reference.stamp_ns, edge.to, Eigen::Isometry3d::Identity(), {}};
  return edge.to;
}

/// Enters the frame tracked last. Keyframes and lost frames with edges become nodes.
void Map::Implementation::locate(const FrameResult& result) {
  const int number = static_cast<int>(frames_.size());
  frames_.emplace_back().stamp_ns = result.stamp_ns;
  const bool has_motion = result.status == FrameStatus::tracked;
  if (has_motion) {
    const int reference = node_of_reference(result.reference_frame);
    last_motion_ = GraphEdge::of(reference, -1,
                                 {*result.current_from_reference, pose::in_other_order(*result.relative_covariance)},
                                 result.diagnostics.rig_sensitivity, false);
    frame(number).node = reference;
    frame(number).node_from_left = result.current_from_reference->inverse();
    frame(number).motion = last_motion_;
    if (result.new_key_rig) node_of_reference(number);
  } else if (result.status != FrameStatus::lost_too_few_edges && result.status != FrameStatus::lost_rig_mismatch) {
    frame(number).node = graph_.add_node(result.pose_or_prediction());
    frame_of_node_.push_back(number);
  }
}

/// \throws UsageError where frames are missing: the odometry refers to them by their numbers
void Map::Implementation::check_is_next() const {
  const auto& latest = odometry::LatestFrame::of(odometry_).frame_edges;
  const int found = latest ? latest->frame : -1, expected = static_cast<int>(frames_.size());
  if (found != expected)
    throw UsageError("a map has to see every frame: the odometry tracked frame " + std::to_string(found) +
                     " last, expected " + std::to_string(expected));
}

bool Map::Implementation::add(const FrameResult& result) {
  check_is_next();
  locate(result);
  const LocatedFrame& now = frames_.back();
  if (now.node < 0) return false;
  const bool is_node = frame_of_node_[static_cast<std::size_t>(now.node)] == static_cast<int>(frames_.size()) - 1;
  const std::size_t waited = waiting_.size();
  bool changed = is_node && recognise(now.node);
  const bool has_entered = waiting_.size() > waited;  // which takes as long as a step
  for (std::size_t steps = waited / kNodesPerStep + (has_entered ? 0 : 1); steps > 0; --steps)
    changed = advance() || changed;
  while (waiting_.size() > kMostWaiting) changed = advance() || changed;
  if (result.world_from_left)
    map_from_odometry_ = graph_.pose(now.node) * now.node_from_left * result.world_from_left->inverse();
  return changed;
}

/// Mean inverse depth of the current frame's edges [1/m].
double Map::Implementation::mean_inverse_depth() const {
  const odometry::LatestFrame now = odometry::LatestFrame::of(odometry_);
  const auto& edges =
      now.frame_edges->measured_edges(corrected_rig(odometry_.rig(), now.frame_edges->rig()), kMinEpipolarAngle);
  double sum = 0, count = 0;
  for (const auto& edge : edges) {
    if (!edge) continue;
    sum += edge->inverse_depth;
    ++count;
  }
  return sum / std::max(1.0, count);
}

/// The place of the node's segment, at least `min_gap` and at most `max_gap` nodes before it, whose view differs least
/// by the map; null if all differ by `most_change` [rad].
const places::Place* Map::Implementation::nearest(int node, int max_gap, int min_gap, double most_change,
                                                  double inverse_depth) const {
  const places::Place* best = nullptr;
  double smallest = most_change;
  for (const places::Place& place : store_.places()) {
    const int gap = node - place.node;
    if (!graph_.is_joined(place.node, node) || gap < min_gap || gap > max_gap) continue;
    const Eigen::Isometry3d motion = graph_.pose(node).inverse() * graph_.pose(place.node);
    const double angle = odometry::view_change(motion, inverse_depth);
    if (angle >= smallest) continue;
    smallest = angle;
    best = &place;
  }
  return best;
}

/// By how much the directions to points may differ from those that a motion of the map predicts [rad].
double Map::Implementation::spread(const GraphEdge& motion, double inverse_depth) const {
  const auto covariance = graph_.whole_covariance(motion);
  const double turn = std::sqrt(covariance.topLeftCorner<3, 3>().trace());
  const double shift = std::sqrt(covariance.bottomRightCorner<3, 3>().trace());
  return kCovered * (turn + shift * inverse_depth);
}

/// Whether a search near the predicted positions covers the uncertainty of a motion.
bool Map::Implementation::is_predictable(const GraphEdge& motion, double inverse_depth) const {
  const double focal = odometry_.rig().left.fx;
  return focal * spread(motion, inverse_depth) < config_.temporal.coarse_radius;
}

/// Whether both ends of a motion of the map may see the same.
bool Map::Implementation::may_overlap(const GraphEdge& motion, double inverse_depth) const {
  return odometry::view_change(motion.measured.transform, inverse_depth) < kMostChange + spread(motion, inverse_depth);
}

bool Map::Implementation::is_worthwhile(const GraphEdge& motion, const NodeView& view) const {
  return motion.measured.covariance.trace() > kWorthwhile * view.variance;
}

/// Compares the current frame, which is a node, with the place that it is known to see. Otherwise it waits for
/// comparisons with similar places, and is kept, unless it adds no view. \returns whether the map has changed
bool Map::Implementation::recognise(int node) {
  const odometry::LatestFrame now = odometry::LatestFrame::of(odometry_);
  const NodeView view{node, static_cast<int>(frames_.size()) - 1, now.frame_edges, mean_inverse_depth(),
                      last_motion_.measured.covariance.trace()};
  const int min_gap = config_.map.min_gap;
  if (const places::Place* seen = nearest(node, node, min_gap + 1, odometry::kSameView, view.inverse_depth)) {
    const GraphEdge motion = graph_.motion(seen->node, node);
    if (is_predictable(motion, view.inverse_depth)) {
      if (!is_worthwhile(motion, view)) return false;
      Comparison comparison = begin(view, *seen, 0, true);
      while (!search_.advance(comparison.search)) {
      }
      const auto closure = list(comparison, view);
      return closure && closures_.decide(*closure);
    }
  } else if (nearest(node, min_gap, 1, kNewView, view.inverse_depth) != nullptr) {
    return false;
  }
  places::Place place{now.frontend.keep(), {}, node};
  place.signature = places::place_signature(place.kept);
  const auto may_be = [&](const places::Place& other) {
    return !graph_.is_joined(other.node, node) || node - other.node > min_gap;
  };
  WaitingNode waiting;
  waiting.view = view;
  for (const auto& similar :
       store_.most_similar(place.signature, places::kCandidateBatches * places::kCandidates, may_be))
    waiting.candidates.push_back({similar.place->node, similar.similarity});
  if (!waiting.candidates.empty()) waiting_.push_back(std::move(waiting));
  store_.add(std::move(place));
  return false;
}

/// Takes one step for the node that waits longest: of the search for the motion from its next place or, after the last
/// place, the decision. \returns whether the map has changed
bool Map::Implementation::advance() {
  if (waiting_.empty()) return false;
  WaitingNode& waiting = waiting_.front();
  if (!waiting.comparison) waiting.comparison = begin_next(waiting);
  if (!waiting.comparison) {
    const WaitingNode done = std::move(waiting);
    waiting_.pop_front();
    return decide_all(done);
  }
  if (!search_.advance(waiting.comparison->search)) return false;
  auto closure = list(*waiting.comparison, waiting.view);
  if (closure && waiting.comparison->is_own) {
    waiting.own = std::move(closure);
  } else if (closure) {
    waiting.joining.push_back(*std::move(closure));
  }
  waiting.comparison.reset();
  return false;
}

/// Begins the comparison with the next candidate that is worth it. \returns nothing if none is left
std::optional<Comparison> Map::Implementation::begin_next(WaitingNode& waiting) {
  const NodeView& view = waiting.view;
  while (waiting.next < waiting.candidates.size()) {
    const bool is_candidate = waiting.next < places::kCandidates;
    const WaitingNode::Candidate& candidate = waiting.candidates[waiting.next++];
    const places::Place* const place = store_.find(candidate.place);
    if (place == nullptr) continue;
    if (!graph_.is_joined(place->node, view.node)) {
      if (is_candidate || closures_.is_rival(place->node, waiting.joining, view.inverse_depth))
        return begin(view, *place, candidate.similarity, false);
    } else if (is_candidate && !waiting.is_own_compared) {
      const GraphEdge motion = graph_.motion(place->node, view.node);
      waiting.is_own_compared = is_worthwhile(motion, view) && may_overlap(motion, view.inverse_depth);
      if (waiting.is_own_compared)
        return begin(view, *place, candidate.similarity, is_predictable(motion, view.inverse_depth));
    }
  }
  return std::nullopt;
}

bool Map::Implementation::decide_all(const WaitingNode& waiting) {
  closures_.reject_contradictions(waiting.joining);
  bool changed = waiting.own && closures_.decide(*waiting.own);
  for (const places::ListedClosure& closure : waiting.joining) changed = closures_.decide(closure) || changed;
  return changed;
}

bool Map::Implementation::finish() {
  bool changed = false;
  while (!waiting_.empty()) changed = advance() || changed;
  return changed;
}

/// Begins the search for the motion from a place to a node, only near the map's if that is known well enough.
Comparison Map::Implementation::begin(const NodeView& view, const places::Place& place, float similarity,
                                      bool near_prediction) {
  odometry::MotionQuery query;
  const odometry::LatestFrame now = odometry::LatestFrame::of(odometry_);
  query.current = view.edges;
  query.base = now.frontend.restore(place.kept);
  query.rig = now.rig.of(view.edges->rig());
  query.rig.disparity_error = 0;  // an error of the rig must not make places alike
  query.seed = config_.seed + static_cast<std::uint64_t>(view.frame);
  if (near_prediction) {
    query.prediction = graph_.pose(view.node).inverse() * graph_.pose(place.node);
    query.only_near_prediction = true;
  }
  Comparison comparison{{}, place.node, graph_.is_joined(place.node, view.node), odometry::MotionSearch::State(query)};
  comparison.closure.frame = view.frame;
  comparison.closure.other = place.kept.frame;
  comparison.closure.similarity = static_cast<double>(similarity);
  return comparison;
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
  places::SavedPlaces saved;
  const StereoRig& rig = odometry_.rig();
  saved.rig = corrected_rig(rig, {});
  saved.is_undistorted = rig.left_undistortion.empty() && rig.right_undistortion.empty() ? 0 : 1;
  const RigEstimate learned = odometry::LatestFrame::of(odometry_).rig;
  saved.offset = learned.disparity_offset;
  saved.offset_variance = learned.disparity_offset_sigma * learned.disparity_offset_sigma;
  saved.settings = places::descriptor_settings(config_);
  std::vector<places::Place> places;
  const int largest = largest_segment();
  for (const places::Place& place : store_.places()) {
    if (graph_.component(place.node) != largest) continue;
    places.push_back(place);
    frontend::KeptFrameEdges& kept = places.back().kept;  // its right image is not displaced from here on
    const Eigen::Vector2d move = -kept.rig.displacement * direction_of_nearer(rig);
    for (float& x : kept.edges.right_x) x += static_cast<float>(move.x());
    for (float& y : kept.edges.right_y) y += static_cast<float>(move.y());
    kept.rig = {};
    saved.poses.push_back(graph_.pose(place.node));
  }
  return {std::move(saved), std::move(places)};
}

Map::Map(StereoOdometry& odometry) {
  const auto use = odometry::LatestFrame::of(odometry).device.use();
  implementation_ = std::make_unique<Implementation>(with_kept_rigs(odometry));
}
Map::~Map() = default;
bool Map::add(const FrameResult& result) {
  const auto use = implementation_->device().use();
  return implementation_->add(result);
}
bool Map::finish() {
  const auto use = implementation_->device().use();
  return implementation_->finish();
}
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
