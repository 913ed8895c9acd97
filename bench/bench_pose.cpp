/// \file bench_pose.cpp  The host's part of a frame on quads of one frame of the built-in sequence: two-quad solver,
/// scoring, RANSAC, refinement. The quads come from the plain C++ reference, so that no OpenCL device is needed.
#include <benchmark/benchmark.h>
#include <optional>

#include "benchmark/frontend_agreement.hpp"
#include "pose/motion.hpp"
#include "pose/ransac.hpp"
#include "pose/refinement.hpp"
#include "pose/scoring.hpp"
#include "pose/two_quads.hpp"
#include "quadedge/synthetic.hpp"

namespace {

using namespace quadedge;

/// Quads between two frames; repeated until there are `wanted`, as a larger image would have them.
struct Quads {
  SyntheticSequence sequence;
  Config config;
  pose::QuadObservations quads;
  Eigen::Isometry3d motion;  ///< the true one, for scoring alone

  explicit Quads(std::size_t wanted) : sequence(options()) {
    config.stereo.max_disparity = sequence.max_disparity();
    FramePrefetcher::Frame frames[2];
    for (int i = 0; i < 2; ++i) {
      frames[i].stamp_ns = sequence.stamp_ns(i);
      frames[i].left = sequence.render(i, false).image;
      frames[i].right = sequence.render(i, true).image;
    }
    Device device("reference");
    const auto seen =
        bench::run_frontend(*frontend::make_frontend(sequence.rig(), device, config), frames[0], frames[1], config);
    TemporalMatches matches;
    for (std::size_t i = 0; i < wanted; ++i) {
      const std::size_t q = i % seen.quads.size();
      matches.append(seen.quads.previous[q], seen.quads.current[q], seen.current, seen.quads.ncc[q],
                     seen.quads.rivals[q]);
    }
    quads = pose::build_quads(sequence.rig(), seen.previous, seen.current, matches, pose::QuadLimits(config));
    motion = sequence.world_from_left(1).inverse() * sequence.world_from_left(0);
  }
  static SyntheticOptions options() {
    SyntheticOptions options;
    options.width = 320;
    options.height = 200;
    options.focal = 184;
    options.baseline = 0.15;
    options.frames = 2;
    return options;
  }
};

const Quads& quads_of(std::int64_t wanted) {
  static std::map<std::int64_t, std::unique_ptr<Quads>> made;
  auto& quads = made[wanted];
  if (!quads) quads = std::make_unique<Quads>(static_cast<std::size_t>(wanted));
  return *quads;
}

void two_quads(benchmark::State& state) {
  const auto& input = quads_of(2000);
  const double max_cosine = pose::ConstraintLimits(input.config.pose).max_cosine;
  std::size_t i = 0;
  for (auto unused : state) {
    (void)unused;
    const std::size_t a = i % input.quads.size(), b = (i * 7 + 1) % input.quads.size();
    benchmark::DoNotOptimize(pose::solve_two_quads(
        {input.quads.previous[a].oriented_point(), input.quads.previous[b].oriented_point()},
        {input.quads.current[a].oriented_point(), input.quads.current[b].oriented_point()}, max_cosine));
    ++i;
  }
}
BENCHMARK(two_quads);

void scoring(benchmark::State& state) {
  const auto& input = quads_of(state.range(0));
  const pose::LaterCameras cameras(input.sequence.rig(), input.motion);
  for (auto unused : state) {
    (void)unused;
    benchmark::DoNotOptimize(pose::truncated_cost(input.quads.scoring, cameras, input.config.pose.inlier_distance));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(input.quads.size()));
}
BENCHMARK(scoring)->Arg(512)->Arg(4000)->Arg(40000);

void ransac(benchmark::State& state) {
  const auto& input = quads_of(state.range(0));
  pose::ConsensusWorkspace workspace;
  for (auto unused : state) {
    (void)unused;
    benchmark::DoNotOptimize(pose::find_consensus(input.quads, input.sequence.rig(), input.config.pose,
                                                  input.config.seed, std::nullopt, workspace));
  }
}
BENCHMARK(ransac)->Arg(4000)->Arg(40000)->Unit(benchmark::kMillisecond);

void refinement(benchmark::State& state) {
  const auto& input = quads_of(state.range(0));
  pose::ConsensusWorkspace search;
  const auto consensus = pose::find_consensus(input.quads, input.sequence.rig(), input.config.pose, input.config.seed,
                                              std::nullopt, search);
  pose::RefinementWorkspace workspace;
  std::vector<std::uint8_t> inlier;
  for (auto unused : state) {
    (void)unused;
    benchmark::DoNotOptimize(pose::refine(input.quads, input.sequence.rig(), input.config.pose,
                                          consensus.current_from_previous, 0, workspace, inlier));
  }
}
BENCHMARK(refinement)->Arg(4000)->Arg(40000)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
