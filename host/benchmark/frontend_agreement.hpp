#pragma once
/// \file frontend_agreement.hpp  Whether two runs of the frontend on the same two frames see the same.

#include <string>

#include "frontend/frontend.hpp"
#include "quadedge/dataset.hpp"

namespace quadedge::bench {

/// What a frontend makes of two frames.
struct FrontendOutput {
  frontend::RigHandle first;  ///< the first frame's rig
  EdgeSet left_edges, right_edges;
  StereoEdges previous, current;
  TemporalMatches coarse, quads;   ///< by a coarse search with its strict limits, and by a guided one
  TemporalMatches global_matches;  ///< between edges anywhere in the left image
};

/// Edges of the first frame stay where they were in both later images, within the radius of a coarse or of a guided
/// search.
TemporalSearch search_without_motion(const StereoEdges& previous, const TemporalConfig& config, bool coarse);

/// Both frames through the frontend, with the quads that both kinds of search find between them around no motion.
FrontendOutput run_frontend(frontend::Frontend& frontend, const FramePrefetcher::Frame& first,
                            const FramePrefetcher::Frame& second, const Config& config);

/// The first difference between two outputs, in the order of the stages: the stage that leaves the values, which edge,
/// which value, and what it is in `a` and in `b`. Empty where every byte of positions, directions, indices and
/// similarities is the same.
std::string first_difference(const FrontendOutput& a, const FrontendOutput& b);

/// Fractions of the stereo edges and of the quads that the other side holds too, within 0.02 px; the smaller one of
/// both ways. A device and the reference round differently, so that candidates at a threshold may differ.
struct Agreement {
  double stereo = 0, quads = 0;
  std::string first;  ///< row that only one side holds, in the order of the stages; empty where there is none
  bool good() const { return stereo > 0.995 && quads > 0.99; }
};
Agreement agreement(const FrontendOutput& a, const FrontendOutput& b);

}  // namespace quadedge::bench
