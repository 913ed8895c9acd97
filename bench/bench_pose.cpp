/// \file bench_pose.cpp  Benchmarks of the pose from the quads of one frame of the built-in sequence.
#include <benchmark/benchmark.h>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

#include "benchmark/compare_frontends.hpp"
#include "motion/quads.hpp"
#include "motion/ransac.hpp"
#include "motion/refinement.hpp"
#include "motion/reprojection_terms.hpp"
#include "motion/scoring.hpp"
#include "motion/two_quads.hpp"
#include "quadedge/synthetic.hpp"

namespace {

using namespace quadedge;

SyntheticOptions options() {
  SyntheticOptions result;
  result.width = 320;
  result.height = 200;
  result.focal = 184;
  result.baseline = 0.15;
  result.frames = 2;
  return result;
}

/// Quads between two frames, from the plain C++ reference, so that no OpenCL device is needed. They are repeated up to
/// the requested number, to simulate a larger image.
struct BenchQuads {
  explicit BenchQuads(std::size_t wanted);
  SyntheticSequence sequence;
  Config config;
  pose::QuadObservations quads;
  Eigen::Isometry3d motion;  ///< true motion, current_from_previous, metres
};

BenchQuads::BenchQuads(std::size_t wanted) : sequence(options()) {
  config.stereo.max_disparity = sequence.rig().max_disparity;
  Device device("reference");
  const auto seen = frontend::run_frontend(*frontend::make_frontend(sequence.rig(), device, config),
                                           sequence.pair(0).view(), sequence.pair(1).view(), config);
  TemporalMatches matches;
  for (std::size_t i = 0; i < wanted; ++i) {
    const std::size_t q = i % seen.quads.size();
    matches.append(seen.quads.previous[q], seen.quads.current[q], seen.current, seen.quads.ncc[q],
                   seen.quads.competing_clusters[q]);
  }
  quads = pose::build_quads(sequence.rig(), seen.previous, seen.current, matches);
  motion = sequence.world_from_left(1).inverse() * sequence.world_from_left(0);
}

/// Returns the same quads at every call.
const BenchQuads& quads_of(std::int64_t wanted) {
  static std::map<std::int64_t, std::unique_ptr<BenchQuads>> made;
  auto& quads = made[wanted];
  if (!quads) quads = std::make_unique<BenchQuads>(static_cast<std::size_t>(wanted));
  return *quads;
}

/// The two-quad solver (Proposition 2).
void two_quads(benchmark::State& state) {
  const auto& input = quads_of(2000);
  std::size_t i = 0;
  for (auto unused : state) {
    (void)unused;
    const std::size_t a = i % input.quads.size(), b = (i * 7 + 1) % input.quads.size();
    benchmark::DoNotOptimize(
        pose::solve_two_quads({input.quads.previous[a].oriented_point(), input.quads.previous[b].oriented_point()},
                              {input.quads.current[a].oriented_point(), input.quads.current[b].oriented_point()}));
    ++i;
  }
}
BENCHMARK(two_quads);

/// The cost of one motion for many quads.
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

/// The complete RANSAC search.
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

/// Terms of all quads.
pose::ReprojectionTerms terms_of(const BenchQuads& input) {
  std::vector<std::int32_t> rows(input.quads.size());
  std::iota(rows.begin(), rows.end(), 0);
  pose::ReprojectionTerms terms;
  terms.assign(input.quads, rows, input.sequence.rig().left, pose::NoiseModel(input.config.pose));
  return terms;
}

void normal_by_pose(benchmark::State& state) {
  const auto& input = quads_of(state.range(0));
  auto terms = terms_of(input);
  for (auto unused : state) {
    (void)unused;
    benchmark::DoNotOptimize(pose::normal_by_pose(terms, input.motion, 0, {}));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(input.quads.size()));
}
BENCHMARK(normal_by_pose)->Arg(1000)->Arg(40000);

void normal_by_pose_and_offset(benchmark::State& state) {
  const auto& input = quads_of(state.range(0));
  auto terms = terms_of(input);
  for (auto unused : state) {
    (void)unused;
    benchmark::DoNotOptimize(pose::normal_by_pose_and_offset(terms, input.motion, 0.1, {}));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(input.quads.size()));
}
BENCHMARK(normal_by_pose_and_offset)->Arg(1000)->Arg(40000);

/// Least squares on all inliers.
void refinement(benchmark::State& state) {
  const auto& input = quads_of(state.range(0));
  pose::ConsensusWorkspace search;
  const auto consensus = pose::find_consensus(input.quads, input.sequence.rig(), input.config.pose, input.config.seed,
                                              std::nullopt, search);
  pose::RefinementWorkspace workspace;
  pose::MotionEstimate motion;
  for (auto unused : state) {
    (void)unused;
    motion.current_from_previous = consensus.current_from_previous;
    benchmark::DoNotOptimize(pose::refine(input.quads, input.sequence.rig(), input.config.pose, 0, workspace, motion));
  }
}
BENCHMARK(refinement)->Arg(4000)->Arg(40000)->Unit(benchmark::kMillisecond);

}  // namespace
