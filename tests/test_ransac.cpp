#include "generated_quads.hpp"
#include "motion/pose_constants.hpp"
#include "motion/ransac.hpp"
#include "motion/two_quads.hpp"

using namespace quadedge::pose;

namespace {

Consensus search(const generated::Problem& problem, const generated::Generated& g, const quadedge::PoseConfig& config,
                 std::uint64_t seed = 42, const std::optional<Eigen::Isometry3d>& initial = std::nullopt) {
  ConsensusWorkspace workspace;
  return find_consensus(g.quads, problem.rig, config, seed, initial, workspace);
}

}  // namespace

TEST_CASE("Consensus is found among 70 % outliers, with exact and noisy quads, for several seeds", "[pose]") {
  quadedge::PoseConfig config;
  generated::Problem problem = generated::drive({});
  problem.outliers = 0.7;
  problem.quads = 800;
  for (const generated::Noise& noise : {generated::Noise{}, generated::Noise{0.12, 0.4, 0.02}}) {
    problem.noise = noise;
    const auto g = generated::generate(problem, 40);
    for (std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
      const Consensus found = search(problem, g, config, seed);
      REQUIRE(found.found);
      CHECK(generated::rotation_error(found.current_from_previous, problem.motion) < 5e-4);
      CHECK(generated::translation_error(found.current_from_previous, problem.motion) < 0.02);
      CHECK(found.hypotheses <= kMaxHypotheses);
      CHECK(found.draws <= config.max_draws);
    }
  }
}

TEST_CASE("A moving object counts by its area in the image, not by its number of edges", "[pose]") {
  generated::Problem scene = generated::drive({}), thing = generated::drive({});
  scene.quads = 600;
  thing.quads = 2400;
  thing.width_ratio = 0.3;
  thing.near = 4;
  thing.far = 6;
  thing.motion.translation() << 0.6, 0, 0.2;
  auto g = generated::generate(scene, 60);
  generated::append(g.quads, generated::generate(thing, 61).quads);
  quadedge::PoseConfig config;
  for (std::uint64_t seed : {1u, 2u, 3u}) {
    const Consensus found = search(scene, g, config, seed);
    REQUIRE(found.found);
    CHECK(generated::translation_error(found.current_from_previous, scene.motion) < 0.02);
  }
  config.scoring_cell = 0;
  CHECK(generated::translation_error(search(scene, g, config).current_from_previous, thing.motion) < 0.02);
}

TEST_CASE("The search terminates with zero, one and two quads, and when no pair of quads passes", "[pose]") {
  quadedge::PoseConfig config;
  generated::Problem problem = generated::drive({});
  for (int count : {0, 1, 2}) {
    problem.quads = count;
    const auto g = generated::generate(problem, 41);
    const Consensus found = search(problem, g, config);
    CHECK(found.draws <= config.max_draws);
    if (count < 2) {
      CHECK_FALSE(found.found);
      CHECK(found.draws == 0);
    }
  }
  // All distances are doubled: constraint 1 fails for each pair.
  problem.quads = 50;
  auto g = generated::generate(problem, 42);
  for (StereoMeasurement& after : g.quads.current) after.inverse_depth *= 0.5;
  CHECK(search(problem, g, config).draws == kMaxHypotheses);  // a consensus of 12 of 50 would have been found
  config.min_inliers = 2;
  config.min_inlier_ratio = 0.03;
  const Consensus found = search(problem, g, config);
  CHECK_FALSE(found.found);
  CHECK(found.draws == static_cast<int>(kDrawsPerPair * 50 * 49 / 2));
  CHECK(found.hypotheses == 0);
  config.max_draws = 700;
  CHECK(search(problem, g, config).draws == 700);
}

TEST_CASE("An initial guess is an additional hypothesis: it helps when right and does no harm when wrong", "[pose]") {
  quadedge::PoseConfig config;
  generated::Problem problem = generated::drive({});
  problem.outliers = 0.5;
  const auto g = generated::generate(problem, 43);
  config.max_draws = 1;
  const Consensus guided = search(problem, g, config, 42, problem.motion);
  REQUIRE(guided.found);
  CHECK(generated::translation_error(guided.current_from_previous, problem.motion) < 1e-3);
  config = quadedge::PoseConfig{};
  Eigen::Isometry3d wrong = Eigen::Isometry3d::Identity();
  wrong.translation() << 1, 1, 1;
  const Consensus misled = search(problem, g, config, 42, wrong);
  REQUIRE(misled.found);
  CHECK(generated::translation_error(misled.current_from_previous, problem.motion) < 1e-3);
}

TEST_CASE("The search stops early when most quads agree, and the same seed gives the same bits", "[pose]") {
  quadedge::PoseConfig config;
  generated::Problem problem = generated::drive({});
  problem.noise = {0.12, 0.4, 0.02};
  problem.outliers = 0.2;
  const auto good = generated::generate(problem, 44);
  const Consensus a = search(problem, good, config, 7), b = search(problem, good, config, 7);
  CHECK(a.hypotheses == config.min_hypotheses);
  CHECK(a.current_from_previous.matrix() == b.current_from_previous.matrix());
  CHECK(a.cost == b.cost);
  CHECK(a.draws == b.draws);
  const Consensus other = search(problem, good, config, 8);
  CHECK(other.draws != a.draws);
}

TEST_CASE("Without local optimisation the motion is that of two measured quads", "[pose]") {
  quadedge::PoseConfig config;
  config.local_optimisation_rounds = 0;
  config.local_optimisation_widening = 1;
  generated::Problem problem = generated::drive({});
  problem.quads = 300;
  const auto exact = generated::generate(problem, 44);
  const Consensus found = search(problem, exact, config);
  REQUIRE(found.found);
  CHECK(generated::rotation_error(found.current_from_previous, problem.motion) < 1e-6);
  // With noisy quads it is one pair's motion, and so less accurate than the locally optimised one.
  problem.noise = generated::Noise{0.12, 0.4, 0.02};
  const auto noisy = generated::generate(problem, 44);
  const Consensus plain = search(problem, noisy, config);
  REQUIRE(plain.found);
  bool of_a_pair = false;
  for (std::size_t a = 0; a < noisy.quads.size() && !of_a_pair; ++a) {
    for (std::size_t b = 0; b < noisy.quads.size() && !of_a_pair; ++b) {
      if (a == b) continue;
      const auto motion =
          solve_two_quads({noisy.quads.previous[a].oriented_point(), noisy.quads.previous[b].oriented_point()},
                          {noisy.quads.current[a].oriented_point(), noisy.quads.current[b].oriented_point()});
      of_a_pair = motion && motion->matrix() == plain.current_from_previous.matrix();
    }
  }
  CHECK(of_a_pair);
  CHECK(generated::translation_error(plain.current_from_previous, problem.motion) >
        generated::translation_error(search(problem, noisy, {}).current_from_previous, problem.motion));
}
