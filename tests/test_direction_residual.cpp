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

TEST_CASE("The direction residual's analytic Jacobian is its derivative", "[pose][direction_residual]") {
  const NoiseModel noise{quadedge::PoseConfig{}};
  generated::for_quads_off_motion([&](const QuadObservations& quads, std::size_t i, const quadedge::StereoRig& /*rig*/,
                                      const Eigen::Isometry3d& pose) {
    const DirectionTerm term = make_direction_term(quads, i, noise);
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
  });
}

TEST_CASE("Direction residuals vanish at the true motion", "[pose][direction_residual]") {
  const generated::Problem problem = generated::near_problem();
  const auto exact = generated::generate(problem, 22);
  for (std::size_t i = 0; i < exact.quads.size(); ++i) {
    const DirectionTerm term = make_direction_term(exact.quads, i, NoiseModel(quadedge::PoseConfig{}));
    CHECK(residual_at(term, problem.motion).value.norm() < 1e-5);
  }
}
