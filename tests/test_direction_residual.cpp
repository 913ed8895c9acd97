#include <catch2/catch.hpp>

#include "generated_quads.hpp"
#include "pose/direction_residual.hpp"
#include "pose/least_squares.hpp"

using namespace quadedge::pose;

namespace {

DirectionResidual residual_at(const DirectionTerm& term, const Eigen::Isometry3d& pose) {
  DirectionResidual result;
  direction_residual(term, pose.linear(), result);
  return result;
}

}  // namespace

TEST_CASE("The analytic Jacobian of the direction residual is its derivative", "[pose][direction_residual]") {
  generated::Random random(20);
  const NoiseModel noise{quadedge::PoseConfig{}};
  for (const auto& rig : {generated::car_rig(), generated::crooked_rig()}) {
    generated::Problem problem;
    problem.rig = rig;
    problem.near = 2;
    problem.far = 20;
    problem.quads = 30;
    problem.motion = random.motion(0.1, 0.5);
    problem.noise = {0.3, 0.5, 0.05};
    const auto g = generated::generate(problem, 21);
    const Eigen::Isometry3d pose = random.motion(0.02, 0.1) * problem.motion;
    for (std::size_t i = 0; i < g.quads.size(); ++i) {
      const DirectionTerm term = make_direction_term(g.quads, i, noise);
      const DirectionResidual analytic = residual_at(term, pose);
      const double h = 1e-5;
      for (int k = 0; k < 3; ++k) {
        Vector6d step = Vector6d::Zero();
        step(k) = h;
        const Eigen::Vector2d numeric =
            (residual_at(term, perturb(step, pose)).value - residual_at(term, perturb(-step, pose)).value) / (2 * h);
        CHECK((numeric - analytic.by_rotation.col(k)).norm() < 1e-5 * (1 + numeric.norm()));
      }
      DirectionTerm sloped = term;
      sloped.tangent += h * term.slope_sigma * term.ray;
      CHECK(((residual_at(sloped, pose).value - analytic.value) / h - analytic.by_slope).norm() <
            1e-4 * (1 + analytic.by_slope.norm()));
    }
  }
}

TEST_CASE("Direction residuals vanish at the true motion", "[pose][direction_residual]") {
  generated::Problem problem;
  problem.rig = generated::crooked_rig();
  problem.near = 2;
  problem.far = 20;
  problem.motion.translation() << 0.1, 0.05, -0.3;
  const auto exact = generated::generate(problem, 22);
  for (std::size_t i = 0; i < exact.quads.size(); ++i) {
    const DirectionTerm term = make_direction_term(exact.quads, i, NoiseModel(quadedge::PoseConfig{}));
    CHECK(residual_at(term, problem.motion).value.norm() < 1e-5);
  }
}
