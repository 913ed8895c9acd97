#pragma once
/// \file temporal_refinement.hpp  Plain C++ twin of kernels/temporal_refinement.cl, double precision.

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"
#include "reference/candidate_filters.hpp"

namespace quadedge::reference {

/// Orders in Table 2: 1 displacement, 2 orientation, 3 NCC, 4 SIFT, 5 and 6 nearly best, 7 agreement, 8 refinement.
inline constexpr int kAgreementOrder = 7;
inline constexpr int kTemporalRefinementOrder = 8;

/// Closes the circle: a living left candidate stays if the right list of its row holds the same current edge alive. Marks the
/// others in `left.rejected_by`; returns per left candidate the mean of both NCC and the right pairing (valid where alive).
struct Agreement {
  std::vector<float> score;
  std::vector<std::uint8_t> right_pairing;
};
Agreement temporal_agreement(const Candidates& left_candidates, CandidateScores& left, const Candidates& right_candidates,
                             const CandidateScores& right);

/// Images of two rigs.
struct RigImages {
  ImageView left, right;
};

/// Refined place of a candidate in both current images [px].
struct RefinedPlace {
  double left_x = 0, left_y = 0, right_x = 0, right_y = 0;
};

/// Refines every living candidate: the left place freely in two dimensions, then the right point along the epipolar line of the
/// new left place, so that the stereo pair stays one (SPEC section 4, filter 6). A prior (config.refine_prior) holds points
/// that their surroundings do not. Marks diverged ones in `scores.rejected_by`. Row r is previous edge r * row_step.
std::vector<RefinedPlace> temporal_refinement(const RigImages& previous_images, const RigImages& current_images,
                                              const StereoEdges& previous, const StereoEdges& current,
                                              const stages::EpipolarGeometry& geometry, const Candidates& candidates,
                                              const Agreement& agreement, const TemporalConfig& config, double patch_offset,
                                              CandidateScores& scores, int row_step = 1);

/// Joins refined candidates that chain up, keeps per row the cluster with the best member (SPEC section 4, filter 7).
TemporalMatches temporal_clusters(const Candidates& candidates, const CandidateScores& scores, const Agreement& agreement,
                                  const std::vector<RefinedPlace>& places, const StereoEdges& current,
                                  const TemporalConfig& config, int row_step = 1);

}  // namespace quadedge::reference
