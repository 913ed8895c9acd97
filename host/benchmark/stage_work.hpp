#pragma once
/// \file stage_work.hpp  The least work of a stage, by its definition: what a perfect kernel could not avoid.

#include <string>

#include "quadedge/config.hpp"

namespace quadedge::bench {

/// Both images of a frame.
struct FrameSize {
  double pixels = 0, edges = 0;
};

/// Every input read once and every output written once, and the arithmetic of the definition (an addition, a
/// multiplication, a comparison each count as one). What a variant does beyond that lowers its fraction of the device's
/// ceilings.
struct StageWork {
  double bytes = 0, operations = 0;
};

/// Of one frame. NaN for the stages whose work depends on the candidates, and for scan.
StageWork least_work(const std::string& stage, const FrameSize& frame, const Config& config);

}  // namespace quadedge::bench
