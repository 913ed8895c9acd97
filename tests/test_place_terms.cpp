#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "generated_quads.hpp"
#include "pose/place_terms.hpp"

using namespace quadedge::pose;

namespace {

using Matrix7d = Eigen::Matrix<double, 7, 7>;
using Vector7d = Eigen::Matrix<double, 7, 1>;

struct Expected {
  Matrix7d matrix = Matrix7d::Zero();
  Vector7d gradient = Vector7d::Zero();
  double cost = 0, depth = 0;
};

/// One quad's contribution from linearise(): Gauss-Newton by (pose, offset, depth) with a standard normal prior on the
/// depth, which the Schur complement takes out.
std::optional<Expected> contribution(const FitTerm& term, const quadedge::PinholeCamera& left,
                                     const Eigen::Isometry3d& pose, double offset, double depth,
                                     const StudentWeights& weights) {
  Linearisation linear;
  if (!linearise(term, left, pose, depth, linear)) return std::nullopt;
  Eigen::Matrix<double, 4, 8> jacobian = Eigen::Matrix<double, 4, 8>::Zero();
  jacobian.topRows<3>() << linear.place_by_pose, linear.place_by_offset, linear.place_by_depth;
  jacobian(3, 7) = 1;
  Eigen::Vector4d residual;
  residual << linear.place + linear.place_by_offset * offset, depth;
  const Eigen::Matrix<double, 8, 8> normal = jacobian.transpose() * jacobian;
  const Eigen::Matrix<double, 8, 1> gradient = jacobian.transpose() * residual;
  Expected result;
  result.depth = depth - gradient(7) / normal(7, 7);
  result.cost = residual.squaredNorm() - gradient(7) * gradient(7) / normal(7, 7);
  const double weight = student_weight(result.cost, weights.scale, kPlaceSize, weights.dof) / weights.scale;
  result.matrix = weight * (normal.topLeftCorner<7, 7>() -
                            normal.topRightCorner<7, 1>() * normal.bottomLeftCorner<1, 7>() / normal(7, 7));
  result.gradient = weight * (gradient.head<7>() - normal.topRightCorner<7, 1>() * (gradient(7) / normal(7, 7)));
  return result;
}

struct Scene {
  explicit Scene(int quads) {
    generated::Random random(50);
    problem.rig = generated::crooked_rig();
    problem.near = 2;
    problem.far = 20;
    problem.quads = quads;
    problem.motion = random.motion(0.1, 0.5);
    problem.noise = {0.3, 0.5, 0.05};
    quads_of = generated::generate(problem, 51).quads;
    pose = random.motion(0.02, 0.1) * problem.motion;
    for (std::size_t i = 0; i < quads_of.size(); i += 2) rows.push_back(static_cast<std::int32_t>(i));
    terms.assign(quads_of, rows, problem.rig.left, noise);
  }
  FitTerm term(std::size_t k) const { return make_term(quads_of, static_cast<std::size_t>(rows[k]), noise); }

  generated::Problem problem;
  quadedge::PoseConfig config;
  NoiseModel noise{config};
  QuadObservations quads_of;
  Eigen::Isometry3d pose;
  std::vector<std::int32_t> rows;
  PlaceTerms terms;
};

template <class A, class B>
void check_close(const A& a, const B& b) {
  CHECK((a - b).norm() < 1e-9 * b.norm());
}

}  // namespace

TEST_CASE("Sums over the places of quads are those of the Jacobians with the depths eliminated",
          "[pose][place_terms]") {
  const StudentWeights weights{1.7, 5};
  const double offset = 0.2;
  for (int quads : {1, 7, 16, 2 * 1024 + 3, 5001}) {
    Scene scene(quads);
    REQUIRE(scene.terms.size() == scene.rows.size());
    std::vector<double> depth(scene.rows.size(), 0.0);
    for (int round = 0; round < 2; ++round) {  // from the second on the depths are not zero
      Expected sum;
      std::vector<double> costs;
      for (std::size_t k = 0; k < scene.rows.size(); ++k) {
        const auto own = contribution(scene.term(k), scene.problem.rig.left, scene.pose, offset, depth[k], weights);
        REQUIRE(own);
        sum.matrix += own->matrix;
        sum.gradient += own->gradient;
        depth[k] = own->depth;
        costs.push_back(own->cost);
      }
      PlaceContributions lanes;
      Matrix6d by_lanes = Matrix6d::Zero();
      Vector6d gradient = Vector6d::Zero();
      for (std::size_t k = 0; k < scene.rows.size(); ++k) {
        if (k % kPlaceLanes == 0) contributions_by_pose(scene.terms, scene.pose, offset, weights, k, lanes);
        by_lanes += lanes.matrix(k % kPlaceLanes);
        gradient += lanes.gradient(k % kPlaceLanes);
      }
      check_close(by_lanes, sum.matrix.topLeftCorner<6, 6>());
      check_close(gradient, sum.gradient.head<6>());
      PlaceTerms same = scene.terms;
      const Normal<6> six = normal_by_pose(same, scene.pose, offset, weights);
      check_close(six.matrix, sum.matrix.topLeftCorner<6, 6>());
      check_close(six.gradient, sum.gradient.head<6>());
      const Normal<7> seven = normal_by_pose_and_offset(scene.terms, scene.pose, offset, weights);
      check_close(seven.matrix, sum.matrix);
      check_close(seven.gradient, sum.gradient);
      for (std::size_t k = 0; k < depth.size(); ++k) {
        CHECK(scene.terms.depth[k] == Approx(depth[k]).margin(1e-9));
        CHECK(scene.terms.error[k] == Approx(costs[k]).epsilon(1e-9));
        CHECK(same.error[k] == scene.terms.error[k]);
      }
    }
  }
}

TEST_CASE("A quad behind the camera counts nothing and keeps its depth and error", "[pose][place_terms]") {
  Scene scene(9);
  normal_by_pose(scene.terms, scene.pose, 0, {});
  const auto depth = scene.terms.depth, error = scene.terms.error;
  Eigen::Isometry3d away = Eigen::Isometry3d::Identity();
  away.translation() << 0, 0, -1000;
  const Normal<6> normal = normal_by_pose(scene.terms, away, 0, {});
  CHECK(normal.matrix.isZero(0));
  CHECK(normal.gradient.isZero(0));
  CHECK(scene.terms.depth == depth);
  CHECK(scene.terms.error == error);
}
