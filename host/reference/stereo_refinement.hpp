#pragma once
/// \file stereo_refinement.hpp  Plain C++ twin of kernels/stereo_refinement.cl, double precision.

#include "quadedge/config.hpp"
#include "quadedge/image.hpp"
#include "reference/candidate_filters.hpp"

namespace quadedge::reference {

/// Position of a point moved onto the epipolar line: along its tangent if the tangent is at least `min_angle` [rad] off
/// the line and the move is shorter than `max_shift` [px], else orthogonally. Returns px from the point at infinity
/// (doc/method.md section 3, 8a).
double epipolar_shift(const EpipolarLine& line, double x, double y, double direction, double min_angle,
                      double max_shift);

/// Refined candidates, one entry each; of no meaning for rejected ones.
struct RefinedCandidates {
  std::vector<double> position;  ///< on the left edge's epipolar line [px from the point at infinity]
  std::vector<double>
      similarity;  ///< of both positions: mean of the NCC of the patches on the edges and of the better equal side
};

/// Shifts and refines every candidate that is alive (doc/method.md section 3, 8a and 8b), and marks diverged ones in
/// `scores.state`.
///
/// Where the paper aligns a side patch, the patch on the edge itself is aligned here, at equal contrast: it holds the
/// edge's own profile, and the flank that another surface owns weighs little. A prior holds it around the detected
/// position, as tightly as an edge is known along this line: refine_prior_sigma / sin(angle between edge and line).
/// `left_patches`: the side patches of the left edges, see reference/patches.hpp.
///
/// Neighbours on one curve shift to the same position. Among candidates within 0.5 px, the one with the most similar
/// sides is refined and represents the others, which keep their positions.
RefinedCandidates stereo_refinement(const ImageView& left_image, const ImageView& right_image,
                                    const std::vector<std::int8_t>& left_patches, const EdgeSet& left,
                                    const EdgeSet& right, const EpipolarGeometry& geometry,
                                    const Candidates& candidates, const StereoConfig& config, double patch_offset,
                                    CandidateScores& scores);

}  // namespace quadedge::reference
