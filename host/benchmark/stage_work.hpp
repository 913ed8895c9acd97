#pragma once
/// \file stage_work.hpp  The least work of a stage, by its definition: what a perfect kernel could not avoid.

#include <string>

#include "benchmark/frontend_agreement.hpp"
#include "quadedge/config.hpp"

namespace quadedge::bench {

/// How much there is to do in a frame that is matched with the one before. Both images together, but where a side is
/// named.
struct FrameSize {
  double pixels = 0, edges = 0, left_edges = 0;
  double stereo_candidates = 0;  ///< that distance, disparity and orientation leave
  double refined = 0;            ///< of them, that are similar enough to be refined
  double clusters = 0;
  double stereo_edges = 0, base_edges = 0;              ///< of this frame, and of the one before
  double guided_candidates = 0, coarse_candidates = 0;  ///< that displacement and orientation leave, both images
  double wide_edges = 0, wide_base_edges = 0;           ///< that are looked for anywhere
};

/// Counts it. `frontend` gets a tap for the time of the call.
FrameSize count_frame(frontend::Frontend& frontend, const FramePrefetcher::Frame& first,
                      const FramePrefetcher::Frame& second, const Config& config);

/// Every input read once and every output written once, and the arithmetic of the definition (an addition, a
/// multiplication, a comparison each count as one). What a variant does beyond that lowers its fraction of the device's
/// ceilings.
struct StageWork {
  double bytes = 0, operations = 0;
};

/// Of one frame, with a guided search and, but for temporal_match, a coarse one of all edges. \throws UsageError for a
/// stage that there is not.
StageWork least_work(const std::string& stage, const FrameSize& frame, const Config& config);

}  // namespace quadedge::bench
