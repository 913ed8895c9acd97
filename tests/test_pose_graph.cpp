#include <unsupported/Eigen/LevenbergMarquardt>
#include <unsupported/Eigen/NumericalDiff>

#include "geometry/uncertain_pose.hpp"
#include "places/pose_graph.hpp"
#include "testing.hpp"

using namespace quadedge;
using places::GraphEdge;
using places::PoseGraph;

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

Eigen::Isometry3d motion(const Vector6& step) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d turn = step.head<3>();
  if (turn.norm() > 0) result.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  result.translation() = step.tail<3>();
  return result;
}

/// Poses on a circle that are driven round twice, motions between neighbours with noise, and closures between the
/// rounds.
struct Circle {
  static constexpr int kRound = 20, kNodes = 2 * kRound;
  static constexpr double kTurn = 0.002, kShift = 0.01;  ///< standard deviations of a motion [rad, m]
  PoseConfig config;
  std::vector<Eigen::Isometry3d> truth;
  std::mt19937 random{1};
  std::vector<GraphEdge> odometry, closures;

  Circle() {
    config.rig_sigma_length = config.rig_sigma_axis = config.rig_sigma_lens = 0;
    for (int i = 0; i < kNodes; ++i) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      const double angle = 2 * 3.14159265358979 * i / kRound;
      pose.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
      pose.translation() = pose.linear() * Eigen::Vector3d(-3, 0, 0);
      truth.push_back(pose);
    }
    for (int i = 1; i < kNodes; ++i) odometry.push_back(measured(i - 1, i, false));
    for (int i = kRound; i < kNodes; i += 4) closures.push_back(measured(i - kRound, i, true));
  }

  GraphEdge measured(int from, int to, bool robust) {
    std::normal_distribution<double> normal;
    Vector6 noise;
    for (int k = 0; k < 6; ++k) noise[k] = (k < 3 ? kTurn : kShift) * normal(random);
    pose::RelativePose step;
    step.transform =
        motion(noise) * truth[static_cast<std::size_t>(to)].inverse() * truth[static_cast<std::size_t>(from)];
    step.covariance.diagonal() << Eigen::Vector3d::Constant(kTurn * kTurn), Eigen::Vector3d::Constant(kShift * kShift);
    return GraphEdge::of(from, to, step, RigSensitivity::Zero(), robust);
  }
  /// The graph with all nodes at the poses of the odometry.
  PoseGraph driven() const {
    PoseGraph graph(config);
    graph.add_node(truth.front());
    for (const GraphEdge& edge : odometry) {
      graph.add_node(Eigen::Isometry3d::Identity());
      graph.add_edge(edge);
    }
    return graph;
  }
  double error(const PoseGraph& graph) const {
    double sum = 0;
    for (int i = 0; i < kNodes; ++i)
      sum += (graph.pose(i).translation() - truth[static_cast<std::size_t>(i)].translation()).norm();
    return sum / kNodes;
  }
};

/// The errors of all edges, for moves of all poses but the first.
struct AllErrors : Eigen::DenseFunctor<double> {
  AllErrors(const std::vector<GraphEdge>& of, const std::vector<Eigen::Isometry3d>& from)
      : DenseFunctor(static_cast<int>(6 * (from.size() - 1)), static_cast<int>(6 * of.size())),
        edges(of),
        poses(from) {}

  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& all) const {
    constexpr double kCauchy = 12.6;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto at = [&](int node) -> Eigen::Isometry3d {
        const Eigen::Isometry3d& pose = poses[static_cast<std::size_t>(node)];
        if (node == 0) return pose;
        return pose * motion(x.segment<6>(6 * (node - 1)));
      };
      const Eigen::Isometry3d difference =
          at(edges[e].to).inverse() * at(edges[e].from) * edges[e].measured.transform.inverse();
      const Eigen::AngleAxisd turn(difference.linear());
      Vector6 error;
      error << turn.angle() * turn.axis() / Circle::kTurn, difference.translation() / Circle::kShift;
      const double squared = error.squaredNorm();
      if (edges[e].robust && squared > 0) error *= std::sqrt(kCauchy * std::log1p(squared / kCauchy) / squared);
      all.segment<6>(static_cast<Eigen::Index>(6 * e)) = error;
    }
    return 0;
  }
  const std::vector<GraphEdge>& edges;
  const std::vector<Eigen::Isometry3d>& poses;
};

/// The minimum by another way: dense, with numerical derivatives.
double dense_minimum(const std::vector<GraphEdge>& edges, const std::vector<Eigen::Isometry3d>& poses) {
  const AllErrors errors(edges, poses);
  Eigen::NumericalDiff<AllErrors> with_derivatives(errors);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(errors.inputs());
  Eigen::LevenbergMarquardt<Eigen::NumericalDiff<AllErrors>> search(with_derivatives);
  search.setMaxfev(1'000'000);  // those of the derivatives count, too
  search.minimize(x);
  return search.fvec().squaredNorm();
}

}  // namespace

TEST_CASE("pose graph: the minimum is that of a dense solution with numerical derivatives") {
  Circle circle;
  PoseGraph graph = circle.driven();
  std::vector<Eigen::Isometry3d> start;
  for (int i = 0; i < graph.nodes(); ++i) start.push_back(graph.pose(i));
  std::vector<GraphEdge> edges = circle.odometry;
  for (const GraphEdge& closure : circle.closures) {
    graph.add_edge(closure);
    edges.push_back(closure);
  }
  const double before = circle.error(graph);
  graph.optimise();
  CHECK(graph.cost() == Approx(dense_minimum(edges, start)).epsilon(1e-4));
  CHECK(circle.error(graph) < 0.5 * before);
}

TEST_CASE("pose graph: with a third of the closures false it ends no worse than the odometry") {
  Circle circle;
  PoseGraph graph = circle.driven();
  const double before = circle.error(graph);
  std::uniform_int_distribution<int> any(0, Circle::kNodes - 1);
  for (const GraphEdge& closure : circle.closures) graph.add_edge(closure);
  for (std::size_t k = 0; k < circle.closures.size() / 2; ++k) {
    GraphEdge wrong = circle.closures[k];
    wrong.from = any(circle.random);
    wrong.to = (wrong.from + Circle::kRound / 2) % Circle::kNodes;
    graph.add_edge(wrong);
  }
  graph.optimise();
  CHECK(circle.error(graph) < before);
}

TEST_CASE("pose graph: the deviation of true motions follows chi^2 with six degrees of freedom") {
  double sum = 0;
  int count = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    Circle circle;
    circle.random.seed(seed);
    circle.odometry.clear();
    for (int i = 1; i < Circle::kNodes; ++i) circle.odometry.push_back(circle.measured(i - 1, i, false));
    const PoseGraph graph = circle.driven();
    sum += graph.deviation(graph.motion(3, 17), circle.measured(3, 17, true));
    sum += graph.deviation(graph.motion(30, 0), circle.measured(0, 30, true).reversed());
    count += 2;
  }
  CHECK(sum / count == Approx(6).margin(1.5));
}

TEST_CASE("pose graph: rounding errors do not grow along a chain") {
  Circle circle;
  PoseGraph graph(circle.config);
  graph.add_node(Eigen::Isometry3d::Identity());
  for (int i = 1; i <= 400; ++i) {
    GraphEdge edge = circle.odometry[static_cast<std::size_t>(i % (Circle::kNodes - 1))];
    edge.from = i - 1;
    edge.to = graph.add_node(graph.pose(i - 1) * edge.measured.transform.inverse());
    graph.add_edge(edge);
  }
  CHECK(graph.cost() < 1e-6);
}

TEST_CASE("pose graph: a calibration error shared by all motions explains what edge noise cannot") {
  for (const double length_error : {0.05, 0.0}) {
    PoseConfig config = Circle().config;
    config.rig_sigma_length = length_error;
    // Every motion is 4 % too long; a closure of the straight way shows it.
    PoseGraph graph(config);
    graph.add_node(Eigen::Isometry3d::Identity());
    pose::RelativePose step;
    step.covariance.diagonal().setConstant(1e-6);
    step.transform.translation() << 0, 0, -1.04;
    const RigSensitivity by_rig = pose::rig_sensitivity(step.transform.inverse(), 0);
    for (int i = 1; i <= 10; ++i) {
      graph.add_node(Eigen::Isometry3d::Identity());
      graph.add_edge(GraphEdge::of(i - 1, i, step, by_rig, false));
    }
    pose::RelativePose whole = step;
    whole.transform.translation() << 0, 0, -10;
    const double deviation =
        graph.deviation(graph.motion(0, 10), GraphEdge::of(0, 10, whole, RigSensitivity::Zero(), true));
    if (length_error > 0)
      CHECK(deviation < 6);
    else
      CHECK(deviation > 1000);
  }
}
