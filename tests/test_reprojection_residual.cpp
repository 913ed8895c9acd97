#include "generated_quads.hpp"
#include "motion/least_squares.hpp"
#include "motion/pose_constants.hpp"
#include "motion/residuals.hpp"
#include "reprojection_jacobian.hpp"

using namespace quadedge;
using namespace quadedge::pose;

TEST_CASE("The reprojection residual's analytic Jacobian is its derivative", "[pose]") {
  const NoiseModel noise{quadedge::PoseConfig{}};
  generated::for_quads_off_motion([&](const QuadObservations& quads, std::size_t i, const quadedge::StereoRig& rig,
                                      const Eigen::Isometry3d& pose) {
    ReprojectionTerm term = make_reprojection_term(quads, i, rig.left, noise);
    term.scale_shift_x = 0.003;
    term.scale_shift_y = -0.002;
    const auto at = [&](const ReprojectionTerm& quad, const Eigen::Isometry3d& motion, double depth) {
      ReprojectionJacobian result;
      REQUIRE(reprojection_jacobian(quad, motion, depth, result));
      return result;
    };
    const ReprojectionJacobian analytic = at(term, pose, 0.7);
    const double h = 1e-5;
    const auto check = [&](const Eigen::Vector3d& plus, const Eigen::Vector3d& minus, const Eigen::Vector3d& column) {
      const Eigen::Vector3d numeric = (plus - minus) / (2 * h);
      CHECK((numeric - column).norm() < 1e-5 * (1 + numeric.norm()));
    };
    for (int k = 0; k < 6; ++k) {
      Vector6d step = Vector6d::Zero();
      step(k) = h;
      check(at(term, perturb(step, pose), 0.7).value, at(term, perturb(-step, pose), 0.7).value,
            analytic.by_pose.col(k));
    }
    check(at(term, pose, 0.7 + h).value, at(term, pose, 0.7 - h).value, analytic.by_depth);
    const auto with_offset = [&](double offset) {
      ReprojectionTerm moved = term;
      moved.inverse_depth += offset * term.inverse_depth_per_pixel;
      moved.current_inverse_depth += offset * term.current_inverse_depth_per_pixel;
      return at(moved, pose, 0.7).value;
    };
    check(with_offset(h), with_offset(-h), analytic.by_offset);
  });
}

TEST_CASE("Standard deviations across an edge, along it, and along it where its length is matched", "[pose]") {
  quadedge::PoseConfig config;
  const NoiseModel noise(config);
  CHECK(noise.on_epipolar_line(1.0) == Approx(config.sigma_across));
  CHECK(noise.on_epipolar_line(0.0) == Approx(pose::kSigmaAlong));
  // A segment of 3 px to both sides has the standard deviation of a uniform distribution, 3 / sqrt(3), whatever the
  // scale of the rest.
  CHECK(noise.along_in_time(0, 1) == Approx(pose::kSigmaAlong));
  CHECK(noise.along_in_time(3, 1) == Approx(std::hypot(pose::kSigmaAlong, std::sqrt(3.0))));
  CHECK(noise.along_in_time(3, 0.25) == Approx(std::hypot(pose::kSigmaAlong, 4 * std::sqrt(3.0))));
}

namespace {

struct DirectionCase {
  DirectionTerm term;
  Vector3 ray;
};

DirectionCase case_of(const QuadObservations& quads, std::size_t i, const NoiseModel& noise) {
  const Eigen::Vector3d& ray = quads.previous[i].ray;
  return {make_direction_term(quads, i, noise), {ray.x(), ray.y(), ray.z()}};
}

DirectionResidual residual_at(const DirectionCase& at, const Eigen::Isometry3d& pose) {
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
    const DirectionCase term = case_of(quads, i, noise);
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
    DirectionCase sloped = term;
    const Vector3 longer = h * term.term.slope_sigma * term.ray;
    sloped.term.tangent = {term.term.tangent.x + longer.x, term.term.tangent.y + longer.y,
                           term.term.tangent.z + longer.z};
    const Eigen::Vector2d by_slope(analytic.left_by_slope, analytic.right_by_slope);
    CHECK(((value_of(residual_at(sloped, pose)) - value_of(analytic)) / h - by_slope).norm() <
          1e-4 * (1 + by_slope.norm()));
  });
}
