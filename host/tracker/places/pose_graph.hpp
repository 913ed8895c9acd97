#pragma once
/// \file pose_graph.hpp  Poses of keyframes from measured motions between them (doc/method.md section 10).

#include <Eigen/Geometry>
#include <Eigen/SparseCore>
#include <vector>

#include "geometry/uncertain_pose.hpp"
#include "quadedge/config.hpp"
#include "quadedge/trajectory.hpp"

namespace quadedge::places {

/// A measured motion between two nodes. Edge errors are independent of those of other motions, calibration errors are
/// the same in all.
struct GraphEdge {
  int from = 0, to = 0;         ///< nodes
  pose::RelativePose measured;  ///< to_from_from
  /// Derivative of `measured` with respect to calibration errors: rotation, then translation, in the frame of `to`.
  RigSensitivity by_rig = RigSensitivity::Zero();
  bool robust = false;  ///< whether it may be false and is weighted by a Cauchy kernel

  /// \param from_from_to_by_rig pose::rig_sensitivity() of the inverse motion
  static GraphEdge of(int from, int to, const pose::RelativePose& measured, const RigSensitivity& from_from_to_by_rig,
                      bool robust);
  /// The motion from `to` to `from`.
  GraphEdge reversed() const;
  /// The motion from `before.from` to `to`, through `before.to`, which is the same place as `from`.
  GraphEdge after(const GraphEdge& before) const;
};

/// Minimises the squared errors of all edges, in standard deviations, over the poses of the nodes, by Gauss-Newton. The
/// calibration is not adapted; its errors (`pose.rig_sigma_*`), the same for all motions, count in deviation(). Nodes
/// that edges connect form a component, which lies in the frame of its first node.
class PoseGraph {
 public:
  explicit PoseGraph(const PoseConfig& config);

  /// Adds a node that no edge connects, at a pose in a frame of its own. \returns its number
  int add_node(const Eigen::Isometry3d& map_from_node);
  /// Connects two nodes. If they belong to different components, the one with the later first node is moved into the
  /// frame of the other.
  void add_edge(const GraphEdge& edge);
  /// Moves the nodes to the minimum.
  void optimise();

  int nodes() const { return static_cast<int>(poses_.size()); }
  const std::vector<GraphEdge>& edges() const { return edges_; }
  const Eigen::Isometry3d& pose(int node) const { return poses_[static_cast<std::size_t>(node)]; }
  /// First node of a node's component.
  int component(int node) const { return components_[static_cast<std::size_t>(node)]; }
  bool is_joined(int one, int other) const { return component(one) == component(other); }

  /// The motion between two nodes of one component at their poses, with the covariance along the most certain chain of
  /// edges between them: that of the graph if it is the only chain, and larger otherwise.
  GraphEdge motion(int from, int to) const;
  /// Squared deviation of two independently measured motions between the same places, in standard deviations of both;
  /// its expectation is six.
  double deviation(const GraphEdge& one, const GraphEdge& other) const;
  /// Covariance of a motion due to edge and calibration errors.
  Eigen::Matrix<double, 6, 6> whole_covariance(const GraphEdge& edge) const;
  /// Sum that optimise() minimises.
  double cost() const;

 private:
  using Block = Eigen::Matrix<double, 6, 6>;
  using Residual = Eigen::Matrix<double, 6, 1>;
  /// Error of an edge and its derivatives with respect to right perturbations of both poses.
  struct Linearised {
    Residual error;
    Block by_from, by_to;
  };
  Linearised linearise(const GraphEdge& edge) const;
  static double weight(const GraphEdge& edge, double squared);
  /// An edge at the poses of its nodes, with the covariance that its weight gives it.
  GraphEdge as_weighted(const GraphEdge& edge) const;
  /// First column of a node in the normal equations; -1 for the first node of a component, which is fixed.
  std::vector<int> columns() const;
  /// Lower triangle.
  Eigen::SparseMatrix<double> normal_equations(const std::vector<int>& columns, Eigen::VectorXd& gradient) const;
  void move(const std::vector<int>& columns, const Eigen::VectorXd& step);

  std::vector<Eigen::Isometry3d> poses_;
  std::vector<int> components_;
  std::vector<GraphEdge> edges_;
  std::vector<std::vector<std::size_t>> edges_of_;  ///< of each node
  Eigen::Matrix<double, kRigErrors, 1> rig_sigma_;
};

}  // namespace quadedge::places
