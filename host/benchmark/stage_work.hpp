#pragma once
/// \file stage_work.hpp  A lower bound for the work of each stage, from its definition.

#include <string>

#include "benchmark/frontend_agreement.hpp"
#include "quadedge/config.hpp"

namespace quadedge::bench {

/// Size of the problem for a frame that is matched with the previous one. Both images together unless a side is named.
struct FrameSize {
  double disparity_range = 0;  ///< [px]
  double pixels = 0, edges = 0, left_edges = 0;
  double stereo_candidates = 0;  ///< after distance, disparity and orientation
  double with_candidates = 0;    ///< edges that have candidates or are some
  double refined = 0;            ///< of these, similar enough to be refined
  double clusters = 0;
  double stereo_edges = 0, base_edges = 0;              ///< of this frame and of the previous one
  double guided_candidates = 0, coarse_candidates = 0;  ///< after displacement and orientation, both images
  double wide_edges = 0, wide_base_edges = 0;           ///< searched for globally
};

/// Counts a frame. Sets a tap on `frontend` during the call.
FrameSize count_frame(frontend::Frontend& frontend, const FramePrefetcher::Frame& first,
                      const FramePrefetcher::Frame& second, const Config& config);

/// Every input read once, every output written once, and the arithmetic of the definition (additions, multiplications
/// and comparisons count as one each). Additional work of a variant lowers its fraction of the device's ceilings.
struct StageWork {
  double bytes = 0, operations = 0;
};

/// For one frame, with a guided search and, except for temporal_match, a coarse search of all edges. \throws UsageError
/// for an unknown stage.
StageWork least_work(const std::string& stage, const FrameSize& frame, const Config& config);

}  // namespace quadedge::bench
