#pragma once
/// \file bench_quads.hpp  Quads of one frame of the built-in sequence, for the benchmarks of host/pose.

#include <Eigen/Geometry>
#include <cstdint>

#include "pose/quads.hpp"
#include "quadedge/config.hpp"
#include "quadedge/synthetic.hpp"

namespace quadedge::bench {

/// Quads between two frames, from the plain C++ reference, so that no OpenCL device is needed; repeated until there are
/// as many as wanted, as a larger image would have them.
struct BenchQuads {
  explicit BenchQuads(std::size_t wanted);

  SyntheticSequence sequence;
  Config config;
  pose::QuadObservations quads;
  Eigen::Isometry3d motion;  ///< the true one, current_from_previous, metres
};

/// The same ones at every call.
const BenchQuads& quads_of(std::int64_t wanted);

}  // namespace quadedge::bench
