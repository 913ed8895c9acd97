#pragma once
/// \file temporal_match.hpp  Plain C++ twin of kernels/temporal_match.cl: the whole cascade in time.

#include "common/filter_limits.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "reference/candidate_filters.hpp"

namespace quadedge::reference {

/// What one image of both rigs holds; descriptions by the number of the stereo edge.
struct TemporalMatchSide {
  const EdgeDescriptions& base;
  const EdgeDescriptions& current;
  int width, height;  ///< of the image [px]
};

/// One image's candidates within the radius and the angle of the prediction, with their final states.
struct TemporalMatchLists {
  Candidates candidates;
  CandidateScores scores;  ///< of the left image: with what the agreement rejected
};

/// The quads of a search, and the intermediate results.
struct TemporalMatchResult {
  TemporalMatchLists left, right;
  TemporalMatches matches;
};

/// The cascade of doc/method.md section 4, with SIFT where the limits of the search ask for it: temporal_candidates()
/// and candidate_filters() in either image, then temporal_agreement() and temporal_best().
/// \param current the stereo edges that are searched
TemporalMatchResult temporal_match(const TemporalSearch& search, const StereoEdges& current,
                                   const TemporalMatchSide& left, const TemporalMatchSide& right,
                                   const TemporalConfig& config);

}  // namespace quadedge::reference
