#include "refinement_trials.hpp"

using namespace quadedge::pose;

TEST_CASE("The covariance stays consistent with few quads and with groups of edges that share errors", "[long][pose]") {
  generated::Problem problem = generated::drive();
  problem.quads = 60;
  const generated::Trials few = generated::run_trials(problem, 200);
  CHECK(few.nees > 0.7);
  CHECK(few.nees < 1.5);
  problem.quads = 1600;
  problem.copies = 8;
  const generated::Trials rows = generated::run_trials(problem, 100);
  CHECK(rows.nees > 0.7);
  CHECK(rows.nees < 1.5);
}

namespace {

/// Moves the later edges of each square region of the image by one error per region, `sigma` px in both directions.
QuadObservations with_region_errors(const generated::Problem& problem, double side, double sigma, std::uint64_t seed) {
  generated::Random random(seed);
  std::vector<Eigen::Vector2d> errors(400);
  for (auto& error : errors) error = sigma * Eigen::Vector2d(random.normal(), random.normal());
  return generated::changed_quads(problem, seed + 1, [&](int, const StereoObservation&, StereoObservation& after) {
    const Eigen::Vector2d region = (after.left / side).array().floor();
    if (region.minCoeff() < 0 || region.maxCoeff() >= 20) return false;
    const auto& error = errors[static_cast<std::size_t>(20 * region.y() + region.x())];
    after.left += error;
    after.right += error;
    return true;
  });
}

}  // namespace

TEST_CASE("The covariance grows with errors that are correlated over large regions, and only with these",
          "[long][pose]") {
  generated::Problem problem = generated::drive();
  problem.quads = 3000;
  quadedge::PoseConfig config;
  constexpr int kTrials = 60;
  for (const double sigma : {0.0, 0.1}) {
    double nees = 0, growth = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto quads = with_region_errors(problem, 90, sigma, 2000 + static_cast<std::uint64_t>(trial));
      const auto refined = generated::refined_by(quads, problem.rig, config, problem.motion);
      const Vector6d error = generated::error_of(refined.current_from_previous, problem.motion);
      nees += error.dot(refined.learned.covariance.ldlt().solve(error)) / (6.0 * kTrials);
      const auto alone = with_region_errors(problem, 90, 0, 2000 + static_cast<std::uint64_t>(trial));
      const auto without = generated::refined_by(alone, problem.rig, config, problem.motion);
      growth += (refined.learned.covariance * without.learned.covariance.inverse()).trace() / (6.0 * kTrials);
    }
    INFO("regions' errors of " << sigma << " px: NEES " << nees << ", covariance times " << growth);
    CHECK(nees > 0.7);
    CHECK(nees < 1.5);
    if (sigma > 0) CHECK(growth > 3);
  }
}
