/// \file pose_graph.cpp  Gauss-Newton on sparse equations, Cauchy weights, and the most certain path by Dijkstra.
#include "places/pose_graph.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace quadedge::places {
namespace {

/// Squared error at which the kernel halves the weight: 95 % of chi^2 with six degrees of freedom.
constexpr double kCauchy = 12.6;
constexpr int kMaxSteps = 20;
constexpr double kSettled = 1e-6;   ///< relative decrease of the cost at which the minimum is reached
constexpr int kMostHalvings = 8;    ///< of a step that increases the cost
constexpr double kMinSigma = 1e-9;  ///< of a calibration error that is assumed to be exact

/// Inverse of the left Jacobian of SO(3): the change of log(R) by a small rotation on the left of R.
Eigen::Matrix3d inverse_left_jacobian(const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  const Eigen::Matrix3d cross = pose::cross_matrix(rotation);
  const double second =
      angle < 1e-4 ? 1.0 / 12 : 1 / (angle * angle) - (1 + std::cos(angle)) / (2 * angle * std::sin(angle));
  return Eigen::Matrix3d::Identity() - 0.5 * cross + second * cross * cross;
}

/// The same transform with a rotation that is exact again, so that rounding errors do not grow along a chain of poses.
Eigen::Isometry3d orthonormal(Eigen::Isometry3d transform) {
  transform.linear() = Eigen::Quaterniond(transform.linear()).normalized().toRotationMatrix();
  return transform;
}

/// `pose` after a perturbation in its own frame: rotation, then translation.
Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const Eigen::Matrix<double, 6, 1>& step) {
  Eigen::Isometry3d change = Eigen::Isometry3d::Identity();
  const double angle = step.head<3>().norm();
  if (angle > 0) change.linear() = Eigen::AngleAxisd(angle, step.head<3>() / angle).toRotationMatrix();
  change.translation() = step.tail<3>();
  return orthonormal(pose * change);
}

}  // namespace

GraphEdge GraphEdge::of(int from, int to, const pose::RelativePose& measured, const RigSensitivity& from_from_to_by_rig,
                        bool robust) {
  const Eigen::Matrix3d to_from_from = measured.transform.linear();
  GraphEdge edge{from, to, measured, RigSensitivity::Zero(), robust};
  // An error of from_from_to along the axes of `from` is the opposite one of its inverse, along the axes of `to`.
  edge.by_rig.topRows<3>() = -to_from_from * from_from_to_by_rig.bottomRows<3>();
  edge.by_rig.bottomRows<3>() = -to_from_from * from_from_to_by_rig.topRows<3>();
  return edge;
}

GraphEdge GraphEdge::reversed() const {
  const Eigen::Isometry3d from_from_to = measured.transform.inverse();
  const Eigen::Matrix<double, 6, 6> back = pose::adjoint(from_from_to);
  return {to, from, {from_from_to, back * measured.covariance * back.transpose()}, -back * by_rig, robust};
}

GraphEdge GraphEdge::after(const GraphEdge& before) const {
  return {before.from, to, measured * before.measured, by_rig + pose::adjoint(measured.transform) * before.by_rig,
          robust || before.robust};
}

PoseGraph::PoseGraph(const PoseConfig& config) : rig_sigma_(pose::rig_sigmas(config).cwiseMax(kMinSigma)) {}

int PoseGraph::add_node(const Eigen::Isometry3d& map_from_node) {
  poses_.push_back(map_from_node);
  components_.push_back(nodes() - 1);
  edges_of_.emplace_back();
  return nodes() - 1;
}

void PoseGraph::add_edge(const GraphEdge& edge) {
  const int from = component(edge.from), to = component(edge.to);
  for (const int node : {edge.from, edge.to}) edges_of_[static_cast<std::size_t>(node)].push_back(edges_.size());
  edges_.push_back(edge);
  if (from == to) return;
  const Eigen::Isometry3d to_in_map = pose(edge.from) * edge.measured.transform.inverse();
  const Eigen::Isometry3d new_from_to = to_in_map * pose(edge.to).inverse();
  const int kept = std::min(from, to), moving = std::max(from, to);
  const Eigen::Isometry3d change = moving == to ? new_from_to : new_from_to.inverse();
  for (int node = 0; node < nodes(); ++node) {
    if (component(node) != moving) continue;
    poses_[static_cast<std::size_t>(node)] = orthonormal(change * pose(node));
    components_[static_cast<std::size_t>(node)] = kept;
  }
}

PoseGraph::Linearised PoseGraph::linearise(const GraphEdge& edge) const {
  const Eigen::Isometry3d predicted = pose(edge.to).inverse() * pose(edge.from);
  const Eigen::Isometry3d difference = predicted * edge.measured.transform.inverse();
  const Eigen::AngleAxisd rotation(difference.linear());
  const Eigen::Vector3d turn = rotation.angle() * rotation.axis();
  Linearised result;
  result.error << turn, difference.translation();
  // A perturbation of the predicted motion on its left changes the error by `change`.
  Block change = Block::Zero();
  change.topLeftCorner<3, 3>() = inverse_left_jacobian(turn);
  change.bottomRightCorner<3, 3>().setIdentity();
  change.bottomLeftCorner<3, 3>() = -pose::cross_matrix(difference.translation());
  result.by_from = change * pose::adjoint(predicted);
  result.by_to = -change;
  return result;
}

double PoseGraph::weight(const GraphEdge& edge, double squared) {
  return edge.robust ? 1 / (1 + squared / kCauchy) : 1;
}

double PoseGraph::cost() const {
  double sum = 0;
  for (const GraphEdge& edge : edges_) {
    const Residual error = linearise(edge).error;
    const double squared = error.dot(edge.measured.covariance.ldlt().solve(error));
    sum += edge.robust ? kCauchy * std::log1p(squared / kCauchy) : squared;
  }
  return sum;
}

std::vector<int> PoseGraph::columns() const {
  std::vector<int> columns(poses_.size(), -1);
  int next = 0;
  for (int node = 0; node < nodes(); ++node) {
    if (component(node) == node) continue;
    columns[static_cast<std::size_t>(node)] = next;
    next += 6;
  }
  return columns;
}

Eigen::SparseMatrix<double> PoseGraph::normal_equations(const std::vector<int>& columns,
                                                        Eigen::VectorXd& gradient) const {
  Eigen::Index size = 0;
  for (const int column : columns)
    if (column >= 0) size = column + 6;
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Eigen::Index row, Eigen::Index column, const Block& block) {
    for (Eigen::Index r = 0; r < block.rows(); ++r)
      for (Eigen::Index c = 0; c < block.cols(); ++c)
        if (row + r >= column + c) entries.emplace_back(row + r, column + c, block(r, c));
  };
  gradient = Eigen::VectorXd::Zero(size);
  for (const GraphEdge& edge : edges_) {
    const Linearised at = linearise(edge);
    const Block information = edge.measured.covariance.inverse();
    const double factor = weight(edge, at.error.dot(information * at.error));
    const std::pair<Eigen::Index, const Block&> parts[] = {{columns[static_cast<std::size_t>(edge.from)], at.by_from},
                                                           {columns[static_cast<std::size_t>(edge.to)], at.by_to}};
    for (const auto& [row, by_row] : parts) {
      if (row < 0) continue;
      const Block weighted = factor * by_row.transpose() * information;
      gradient.segment<6>(row) += weighted * at.error;
      for (const auto& [column, by_column] : parts)
        if (column >= 0 && row >= column) add(row, column, weighted * by_column);
    }
  }
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

void PoseGraph::move(const std::vector<int>& columns, const Eigen::VectorXd& step) {
  for (std::size_t node = 0; node < poses_.size(); ++node)
    if (columns[node] >= 0) poses_[node] = moved(poses_[node], step.segment<6>(columns[node]));
}

void PoseGraph::optimise() {
  const std::vector<int> columns = this->columns();
  double best = cost();
  for (int round = 0; round < kMaxSteps; ++round) {
    Eigen::VectorXd gradient;
    const Eigen::SparseMatrix<double> matrix = normal_equations(columns, gradient);
    if (matrix.rows() == 0) return;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
    Eigen::VectorXd step = -factor.solve(gradient);
    const auto poses = poses_;
    double found = best;
    for (int halving = 0; halving <= kMostHalvings; ++halving, step *= 0.5) {
      move(columns, step);
      found = cost();
      if (found <= best) break;
      poses_ = poses;
    }
    if (!(found < best - kSettled * best)) return;
    best = found;
  }
}

GraphEdge PoseGraph::as_weighted(const GraphEdge& edge) const {
  const Residual error = linearise(edge).error;
  GraphEdge result = edge;
  result.measured.transform = pose(edge.to).inverse() * pose(edge.from);
  result.measured.covariance /= weight(edge, error.dot(edge.measured.covariance.ldlt().solve(error)));
  return result;
}

GraphEdge PoseGraph::motion(int from, int to) const {
  // Dijkstra's algorithm; of the variances, 1 rad counts as much as 1 m.
  std::map<int, std::pair<double, std::size_t>> reached{{from, {0, 0}}};  // variance, edge that leads there
  std::set<std::pair<double, int>> next{{0, from}};
  while (!next.empty() && next.begin()->second != to) {
    const auto [variance, node] = *next.begin();
    next.erase(next.begin());
    for (const std::size_t e : edges_of_[static_cast<std::size_t>(node)]) {
      const int other = edges_[e].from == node ? edges_[e].to : edges_[e].from;
      const double there = variance + as_weighted(edges_[e]).measured.covariance.trace();
      const auto found = reached.find(other);
      if (found != reached.end() && found->second.first <= there) continue;
      if (found != reached.end()) next.erase({found->second.first, other});
      reached[other] = {there, e};
      next.insert({there, other});
    }
  }
  GraphEdge result{to, to, {}};
  while (result.from != from) {
    const GraphEdge last = as_weighted(edges_[reached.at(result.from).second]);
    result = result.after(last.to == result.from ? last : last.reversed());
  }
  return result;
}

double PoseGraph::deviation(const GraphEdge& one, const GraphEdge& other) const {
  const Eigen::Isometry3d difference = one.measured.transform * other.measured.transform.inverse();
  const Eigen::AngleAxisd rotation(difference.linear());
  Residual error;
  error << rotation.angle() * rotation.axis(), difference.translation();
  GraphEdge both = one;
  both.measured.covariance += other.measured.covariance;
  both.by_rig -= other.by_rig;
  return error.dot(whole_covariance(both).ldlt().solve(error));
}

Eigen::Matrix<double, 6, 6> PoseGraph::whole_covariance(const GraphEdge& edge) const {
  return edge.measured.covariance + edge.by_rig * rig_sigma_.cwiseAbs2().asDiagonal() * edge.by_rig.transpose();
}

}  // namespace quadedge::places
