#pragma once
/// \file closures.hpp  Which of the measured motions between similar places a map believes (doc/method.md section 10).

#include <deque>
#include <optional>
#include <vector>

#include "places/pose_graph.hpp"
#include "quadedge/map.hpp"

namespace quadedge::odometry {
struct MotionStep;
}

namespace quadedge::places {

/// A closure that may be kept.
struct ListedClosure {
  std::size_t number;  ///< in Closures::all()
  GraphEdge edge;      ///< from the node of the place to that of the frame
};

/// All closures of a map, and the decision which become edges of its graph.
class Closures {
 public:
  explicit Closures(PoseGraph& graph) : graph_(graph) {}

  /// Lists the outcome of a comparison with a place. \param compared without a motion \param place, node of the place
  /// and of the frame \returns the closure, if a motion was found
  std::optional<ListedClosure> list(const Closure& compared, int place, int node, const odometry::MotionStep& step);
  /// Whether the node `place` lies in a segment that a closure of a frame would join, but where it does not see what
  /// the frame sees. \param joining closures of the frame \param inverse_depth mean of what the frame sees [1/m]
  bool is_rival(int place, const std::vector<ListedClosure>& joining, double inverse_depth) const;
  /// Marks closures of a frame with one other segment as ambiguous if they place it in different parts of that segment.
  void reject_contradictions(const std::vector<ListedClosure>& joining);
  /// Keeps a closure if the map expects it, or if it agrees with one that waits. \returns whether the graph has changed
  bool decide(const ListedClosure& closure);
  const std::vector<Closure>& all() const { return all_; }

 private:
  bool is_certain(const ListedClosure& closure) const;
  bool agree(GraphEdge confirming, const GraphEdge& edge) const;
  void keep(const ListedClosure& closure);
  Closure& listed(const ListedClosure& closure) { return all_[closure.number]; }

  PoseGraph& graph_;
  std::vector<Closure> all_;
  std::deque<ListedClosure> pending_;  ///< the latest kMostPending that no other has confirmed
};

}  // namespace quadedge::places
