#include "map/pose_graph.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace quadedge::map {
namespace {

/// Squared error at which the kernel halves the weight: 95 % of chi^2 with six degrees of freedom.
constexpr double kCauchy = 12.6;
constexpr int kMaxSteps = 20;
constexpr double kSettled = 1e-6;   ///< relative decrease of the cost at which the minimum is reached
constexpr int kMostHalvings = 8;    ///< of a step that increases the cost
constexpr double kMinSigma = 1e-9;  ///< of a calibration error that is assumed to be exact

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

/// Inverse of the left Jacobian of SO(3): the change of log(R) by a small rotation on the left of R.
Eigen::Matrix3d inverse_left_jacobian(const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  const Eigen::Matrix3d cross = cross_matrix(rotation);
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

PoseGraph::PoseGraph(const PoseConfig& config) {
  rig_sigma_ << config.rig_sigma_length, Eigen::Vector3d::Constant(config.rig_sigma_axis_rad()), config.rig_sigma_focal,
      Eigen::Vector3d::Constant(config.rig_sigma_lens);
  rig_sigma_ = rig_sigma_.cwiseMax(kMinSigma);
}

int PoseGraph::add_node(const Eigen::Isometry3d& map_from_node) {
  poses_.push_back(map_from_node);
  components_.push_back(nodes() - 1);
  return nodes() - 1;
}

void PoseGraph::add_edge(const GraphEdge& edge) {
  const int from = component(edge.from), to = component(edge.to);
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
  change.bottomLeftCorner<3, 3>() = -cross_matrix(difference.translation());
  Block carried = Block::Zero();
  carried.topLeftCorner<3, 3>() = carried.bottomRightCorner<3, 3>() = predicted.linear();
  carried.bottomLeftCorner<3, 3>() = cross_matrix(predicted.translation()) * predicted.linear();
  result.by_from = change * carried;
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
  Eigen::Index rig = 0;
  for (const int column : columns)
    if (column >= 0) rig = column + 6;
  const Eigen::Index size = rig + kRigErrors;
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Eigen::Index row, Eigen::Index column, const Eigen::MatrixXd& block) {
    for (Eigen::Index r = 0; r < block.rows(); ++r)
      for (Eigen::Index c = 0; c < block.cols(); ++c)
        if (row + r >= column + c) entries.emplace_back(row + r, column + c, block(r, c));
  };
  gradient = Eigen::VectorXd::Zero(size);
  for (const GraphEdge& edge : edges_) {
    const Linearised at = linearise(edge);
    const Block information = edge.measured.covariance.inverse();
    const double factor = weight(edge, at.error.dot(information * at.error));
    const int from = columns[static_cast<std::size_t>(edge.from)], to = columns[static_cast<std::size_t>(edge.to)];
    struct Part {
      Eigen::Index column;
      Eigen::MatrixXd derivative;
    };
    std::vector<Part> parts;
    if (from >= 0) parts.push_back({from, at.by_from});
    if (to >= 0) parts.push_back({to, at.by_to});
    parts.push_back({rig, -edge.by_rig});
    for (const Part& a : parts) {
      const Eigen::MatrixXd weighted = factor * a.derivative.transpose() * information;
      gradient.segment(a.column, a.derivative.cols()) += weighted * at.error;
      for (const Part& b : parts)
        if (a.column >= b.column) add(a.column, b.column, weighted * b.derivative);
    }
  }
  add(rig, rig, rig_sigma_.cwiseAbs2().cwiseInverse().asDiagonal().toDenseMatrix());
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
    const Eigen::Index size = matrix.rows() - kRigErrors;
    if (size == 0) return;
    const Eigen::SparseMatrix<double> of_poses = matrix.topLeftCorner(size, size);
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(of_poses);
    Eigen::VectorXd step = -factor.solve(gradient.head(size));
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

double PoseGraph::deviation(const GraphEdge& edge) const {
  const std::vector<int> columns = this->columns();
  Eigen::VectorXd gradient;
  const Eigen::SparseMatrix<double> matrix = normal_equations(columns, gradient);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
  const Linearised at = linearise(edge);
  Eigen::MatrixXd derivative = Eigen::MatrixXd::Zero(matrix.rows(), 6);
  const int from = columns[static_cast<std::size_t>(edge.from)], to = columns[static_cast<std::size_t>(edge.to)];
  if (from >= 0) derivative.middleRows<6>(from) = at.by_from.transpose();
  if (to >= 0) derivative.middleRows<6>(to) = at.by_to.transpose();
  derivative.bottomRows<kRigErrors>() = -edge.by_rig.transpose();
  const Eigen::MatrixXd solved = factor.solve(derivative);
  const Block covariance = derivative.transpose() * solved + edge.measured.covariance;
  return at.error.dot(covariance.ldlt().solve(at.error));
}

}  // namespace quadedge::map
