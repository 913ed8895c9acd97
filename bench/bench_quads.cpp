#include "bench_quads.hpp"

#include <map>
#include <memory>

#include "benchmark/frontend_agreement.hpp"

namespace quadedge::bench {

namespace {

SyntheticOptions options() {
  SyntheticOptions result;
  result.width = 320;
  result.height = 200;
  result.focal = 184;
  result.baseline = 0.15;
  result.frames = 2;
  return result;
}

}  // namespace

BenchQuads::BenchQuads(std::size_t wanted) : sequence(options()) {
  config.stereo.max_disparity = sequence.rig().max_disparity;
  FramePrefetcher::Frame frames[2];
  for (int i = 0; i < 2; ++i) {
    frames[i].stamp_ns = sequence.stamp_ns(i);
    frames[i].left = sequence.render(i, Side::left).image;
    frames[i].right = sequence.render(i, Side::right).image;
  }
  Device device("reference");
  const auto seen =
      run_frontend(*frontend::make_frontend(sequence.rig(), device, config), frames[0], frames[1], config);
  TemporalMatches matches;
  for (std::size_t i = 0; i < wanted; ++i) {
    const std::size_t q = i % seen.quads.size();
    matches.append(seen.quads.previous[q], seen.quads.current[q], seen.current, seen.quads.ncc[q],
                   seen.quads.competing_clusters[q]);
  }
  quads = pose::build_quads(sequence.rig(), seen.previous, seen.current, matches, pose::QuadLimits(config));
  motion = sequence.world_from_left(1).inverse() * sequence.world_from_left(0);
}

const BenchQuads& quads_of(std::int64_t wanted) {
  static std::map<std::int64_t, std::unique_ptr<BenchQuads>> made;
  auto& quads = made[wanted];
  if (!quads) quads = std::make_unique<BenchQuads>(static_cast<std::size_t>(wanted));
  return *quads;
}

}  // namespace quadedge::bench
