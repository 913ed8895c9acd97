#pragma once
/// \file bench_quads.hpp  Quads of one frame of the built-in sequence, for the benchmarks of host/pose.

#include <Eigen/Geometry>
#include <cstdint>

#include "pose/quads.hpp"
#include "quadedge/config.hpp"
#include "quadedge/synthetic.hpp"

namespace quadedge::bench {

/// Quads between two frames, from the plain C++ reference, so that no OpenCL device is needed. They are repeated up to
/// the requested number, to simulate a larger image.
struct BenchQuads {
  explicit BenchQuads(std::size_t wanted);

  SyntheticSequence sequence;
  Config config;
  pose::QuadObservations quads;
  Eigen::Isometry3d motion;  ///< true motion, current_from_previous, metres
};

/// Returns the same quads at every call.
const BenchQuads& quads_of(std::int64_t wanted);

}  // namespace quadedge::bench
