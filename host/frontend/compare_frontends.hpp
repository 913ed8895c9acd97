#pragma once
/// \file compare_frontends.hpp  Compares two runs of the front end on the same two frames.

#include <string>

#include "frontend/frontend.hpp"

namespace quadedge::frontend {

/// The output of a front end for two frames.
struct FrontendOutput {
  FrameEdgesHandle first;  ///< the first frame's rig
  EdgeSet left_edges, right_edges;
  StereoEdges previous, current;
  TemporalMatches coarse, quads;   ///< of a coarse search with its strict limits, and of a guided search
  TemporalMatches global_matches;  ///< between edges anywhere in the left image
};

/// Processes both frames and matches them by both kinds of search, predicting no motion.
FrontendOutput run_frontend(Frontend& frontend, const StereoFrame& first, const StereoFrame& second,
                            const Config& config);

/// The first difference between two outputs in the order of the stages: stage, edge, kind of value, and the value in
/// `a` and in `b`. Empty if positions, directions, indices and similarities are identical in every byte.
std::string first_difference(const FrontendOutput& a, const FrontendOutput& b);

/// Fractions of the stereo edges and of the quads that both outputs contain, within 0.02 px; the smaller fraction of
/// the two directions. A device and the reference round differently, so candidates near a threshold may differ.
struct Agreement {
  double stereo = 0, quads = 0;
  std::string first;  ///< the first row that only one output contains, in the order of the stages; empty if none
  bool good() const { return stereo > 0.995 && quads > 0.99; }
};
Agreement agreement(const FrontendOutput& a, const FrontendOutput& b);

}  // namespace quadedge::frontend
