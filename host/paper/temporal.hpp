#pragma once
/// \file temporal.hpp  The temporal cascade of the paper (section 5.2, Table 2): each image by itself, then quads.

#include "paper/cascade.hpp"
#include "quadedge/config.hpp"

namespace quadedge::paper {

/// The stereo edges of a rig as one of its cameras sees them.
struct StereoEdgesInView {
  const Picture& picture;
  EdgePositionsView edges;
  const Described& described;
  int width, height;  ///< of the image [px]
};

/// Candidates in one image after each filter. Row i is stereo edge i of the earlier rig.
struct SideMatching {
  reference::Candidates candidates;            ///< after displacement and orientation
  reference::CandidateScores scores;           ///< and the decisions of the filters on them
  std::vector<std::vector<Cluster>> clusters;  ///< of the refined candidates, per row
};

/// Current edges within `radius` px of the previous position whose direction differs by at most `orientation`, modulo
/// half a turn [rad].
reference::Candidates near_previous(const StereoEdgesInView& before, const StereoEdgesInView& now, double radius,
                                    double orientation);

/// Filters 1 to 8. \param all_scores see judge()
SideMatching match_side(const StereoEdgesInView& before, const StereoEdgesInView& now, const TemporalConfig& config,
                        const RefinementSettings& settings, bool all_scores);

/// Two clusters that hold the same current stereo edge: the circle is closed.
struct Quad {
  std::size_t left, right;  ///< numbers of the clusters in their rows
  std::int32_t edge;        ///< of the edges that both hold, the nearest to the left centroid
};

/// The quads of one row, at most one per pair of clusters.
std::vector<Quad> close_loop(const std::vector<Cluster>& left, const std::vector<Cluster>& right);

/// All quads of two rigs, in the order of the previous edges, of which each may own several.
TemporalMatches quads_of(const SideMatching& left, const SideMatching& right);

}  // namespace quadedge::paper
