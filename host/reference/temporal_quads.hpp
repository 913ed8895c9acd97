#pragma once
/// \file temporal_quads.hpp  Plain C++ twin of kernels/temporal_quads.cl.

#include "common/filter_limits.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "reference/candidate_filters.hpp"

namespace quadedge::reference {

/// Closes the circle: a living left candidate stays if the right list of its row holds the same current edge alive.
/// Marks the others in `left.state`; returns per left candidate the mean of both NCC (valid where alive).
std::vector<float> temporal_agreement(const Candidates& left_candidates, CandidateScores& left,
                                      const Candidates& right_candidates, const CandidateScores& right);

/// The quad of every row: its most similar candidate, after subtracting distance_weight (d / radius)^2, where d is the
/// distance from the predicted left position. Along a curve of uniform appearance the prediction decides.
/// `competing_clusters` counts further groups of candidates that do not chain up with the winner's (doc/method.md
/// section 4, filter 8).
///
/// The paper's photometric refinement in time is left out: positions detected in both rigs are better than refined
/// ones, and in a search that a coarse motion guides it rejected nothing but true quads (rendered room: 70.7 % recall
/// at 98.2 % precision without it, 67.9 % at 98.2 % with it).
TemporalMatches temporal_best(const Candidates& candidates, const CandidateScores& scores,
                              const std::vector<float>& agreement, const StereoEdges& current,
                              const TemporalConfig& config, const TemporalSearch& search);

}  // namespace quadedge::reference
