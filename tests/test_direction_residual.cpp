#include "generated_quads.hpp"
#include "motion/least_squares.hpp"
#include "motion/residuals.hpp"

using namespace quadedge::pose;

namespace {

struct Case {
  DirectionTerm term;
  Vector3 ray;
};

Case case_of(const QuadObservations& quads, std::size_t i, const NoiseModel& noise) {
  const Eigen::Vector3d& ray = quads.previous[i].ray;
  return {make_direction_term(quads, i, noise), {ray.x(), ray.y(), ray.z()}};
}

DirectionResidual residual_at(const Case& at, const Eigen::Isometry3d& pose) {
  const auto rotated = [&](const Vector3& v) -> Vector3 {
    const Eigen::Vector3d turned = pose.linear() * Eigen::Vector3d(v.x, v.y, v.z);
    return {turned.x(), turned.y(), turned.z()};
  };
  return direction_residual(at.term, rotated(at.ray), rotated(at.term.tangent));
}

Eigen::Vector2d value_of(const DirectionResidual& residual) { return {residual.left, residual.right}; }

}  // namespace

TEST_CASE("The direction residual's analytic Jacobian is its derivative", "[pose]") {
  const NoiseModel noise{quadedge::PoseConfig{}};
  generated::for_quads_off_motion([&](const QuadObservations& quads, std::size_t i, const quadedge::StereoRig& /*rig*/,
                                      const Eigen::Isometry3d& pose) {
    const Case term = case_of(quads, i, noise);
    const DirectionResidual analytic = residual_at(term, pose);
    const Vector3 &left = analytic.left_by_rotation, &right = analytic.right_by_rotation;
    Eigen::Matrix<double, 2, 3> by_rotation;
    by_rotation << left.x, left.y, left.z, right.x, right.y, right.z;
    const double h = 1e-5;
    for (int k = 0; k < 3; ++k) {
      Vector6d step = Vector6d::Zero();
      step(k) = h;
      const Eigen::Vector2d numeric =
          (value_of(residual_at(term, perturb(step, pose))) - value_of(residual_at(term, perturb(-step, pose)))) /
          (2 * h);
      CHECK((numeric - by_rotation.col(k)).norm() < 1e-5 * (1 + numeric.norm()));
    }
    Case sloped = term;
    const Vector3 longer = h * term.term.slope_sigma * term.ray;
    sloped.term.tangent = {term.term.tangent.x + longer.x, term.term.tangent.y + longer.y,
                           term.term.tangent.z + longer.z};
    const Eigen::Vector2d by_slope(analytic.left_by_slope, analytic.right_by_slope);
    CHECK(((value_of(residual_at(sloped, pose)) - value_of(analytic)) / h - by_slope).norm() <
          1e-4 * (1 + by_slope.norm()));
  });
}

TEST_CASE("Direction residuals vanish at the true motion", "[pose]") {
  const generated::Problem problem = generated::near_problem();
  const auto exact = generated::generate(problem, 22);
  for (std::size_t i = 0; i < exact.quads.size(); ++i) {
    const Case term = case_of(exact.quads, i, NoiseModel(quadedge::PoseConfig{}));
    CHECK(value_of(residual_at(term, problem.motion)).norm() < 1e-5);
  }
}
