#pragma once
/// \file packed_positions.hpp  Positions and directions of edges on the device, as stages pass them on.

#include "common/layouts.hpp"
#include "opencl/buffer.hpp"

namespace quadedge::stages {

/// Where x, y [px] and direction [rad] of some edges stand in a buffer that another object owns.
struct PositionsView {
  const opencl::Buffer<cl_float>& packed;
  PackedPositions at;
};

}  // namespace quadedge::stages
