#include "refinement_trials.hpp"

using namespace quadedge::pose;

namespace {

/// Quads of a drive, seen by a rig whose right principal point is off its calibration: by `offset` px in both frames,
/// and by `later` px more in the current one.
QuadObservations quads_with_offset(const generated::Problem& problem, double offset, std::uint64_t seed,
                                   double later = 0) {
  return generated::changed_quads(problem, seed, [&](int, StereoObservation& before, StereoObservation& after) {
    before.right.x() += offset;
    after.right.x() += offset + later;
    return true;
  });
}

}  // namespace

TEST_CASE("An offset of all disparities makes the motion too long unless it is fitted", "[pose]") {
  generated::Problem problem = generated::drive();
  problem.quads = 3000;
  quadedge::PoseConfig config;
  const double length = problem.motion.translation().norm();
  for (const double offset : {0.3, -0.2}) {
    const auto quads = quads_with_offset(problem, offset, 41);
    const auto plain = generated::refined_by(quads, problem.rig, config, problem.motion);
    const auto fitted = generated::refined_by(quads, problem.rig, config, problem.motion, 0.3 * 0.3);
    CHECK(plain.offset == 0);
    // Disparities that are too small by the offset enlarge all distances, the motion included.
    CHECK((plain.current_from_previous.translation().norm() - length) * offset > 0);
    // By more than it adds to the nearest points.
    const double largest_disparity = problem.rig.left.fx * problem.rig.baseline() / problem.near;
    CHECK(std::abs(plain.current_from_previous.translation().norm() / length - 1) >
          std::abs(offset) / largest_disparity);
    CHECK(fitted.learned.offset == Approx(offset).margin(4 * std::sqrt(fitted.learned.offset_variance)));
    CHECK(fitted.offset == Approx(offset).margin(0.15));
    CHECK(fitted.learned.offset_variance < 0.25 * 0.3 * 0.3);  // of the prior; the quads of a frame share errors
    CHECK(std::abs(fitted.current_from_previous.translation().norm() / length - 1) < 0.002);
    const Vector6d error = generated::error_of(fitted.current_from_previous, problem.motion);
    CHECK(error.dot(fitted.learned.covariance.ldlt().solve(error)) <
          22.5);  // 99.9 % of a chi-squared distribution with 6 degrees
  }
}

TEST_CASE("A camera at rest leaves the disparity offset undetermined", "[pose]") {
  generated::Problem problem = generated::drive();
  problem.motion = Eigen::Isometry3d::Identity();
  quadedge::PoseConfig config;
  const auto quads = quads_with_offset(problem, 0.3, 43);
  const auto fitted = generated::refined_by(quads, problem.rig, config, problem.motion, 0.3 * 0.3);
  CHECK(fitted.learned.offset_variance > 0.9 * 0.3 * 0.3);
  CHECK(std::abs(fitted.offset) < 0.1);
  CHECK(fitted.current_from_previous.translation().norm() < 0.01);
}

TEST_CASE("Systematic errors are not learned as an offset where that looks like a motion", "[pose]") {
  generated::Problem problem = generated::drive();
  problem.quads = 3000;
  problem.near = 12;
  problem.far = 15;
  problem.noise = {0.02, 0.07, 0.005};
  quadedge::PoseConfig config;
  const double length = problem.motion.translation().norm();
  for (const double later : {0.02, -0.02}) {
    const auto quads = quads_with_offset(problem, 0, 47, later);
    const auto fitted = generated::refined_by(quads, problem.rig, config, problem.motion, 0.3 * 0.3);
    CAPTURE(fitted.offset, fitted.learned.offset, fitted.learned.offset_variance);
    CHECK(std::abs(fitted.offset) > 5 * std::abs(later));
    CHECK(std::abs(fitted.learned.offset) < 0.6 * std::abs(fitted.offset));
    CHECK(std::abs(fitted.offset) < 2 * std::sqrt(fitted.learned.offset_variance));
    CHECK(std::abs(fitted.learned.current_from_previous.translation().norm() - length) <
          std::abs(fitted.current_from_previous.translation().norm() - length));
  }
}
