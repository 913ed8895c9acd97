#pragma once
/// \file compare_frontends.hpp  Compares the bytes that two front ends find in the same two frames.

#include <string>

#include "edges/frontend.hpp"

namespace quadedge::frontend {

/// The output of a front end for two frames.
struct FrontendOutput {
  FrameEdgesHandle first;  ///< those of the first frame
  EdgeSet left_edges, right_edges;
  StereoEdges previous, current;
  TemporalMatches quads;                   ///< of a guided search
  TemporalMatches coarse, global_matches;  ///< of a search with strict limits, and anywhere in the left image; none in
                                           ///< the paper's method
};

/// Processes both frames and matches them by both kinds of search, predicting no motion.
FrontendOutput run_frontend(Frontend& frontend, const StereoFrame& first, const StereoFrame& second,
                            const Config& config);

/// The first difference between two outputs in the order of the stages: stage, edge, kind of value, and the value in
/// `a` and in `b`. Empty if positions, directions, indices and similarities are identical in every byte.
std::string first_difference(const FrontendOutput& a, const FrontendOutput& b);

}  // namespace quadedge::frontend
