#pragma once
/// \file stereo_matching.hpp  Plain C++ twins of stages 4a and 5, but for the coarse disparity.

#include <cstdint>
#include <vector>

#include "geometry/disparity_range.hpp"
#include "geometry/epipolar_geometry.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"
#include "reference/candidates.hpp"
#include "reference/coarse_disparity.hpp"

namespace quadedge::reference {

// Plain C++ twin of kernels/stereo_candidates.cl.

/// Filters 1 to 3 of doc/method.md section 3 for every left edge. Needs right.row_first only to skip far rows.
Candidates stereo_candidates(const EdgeSet& left, const EdgeSet& right, const EpipolarGeometry& geometry,
                             const DisparityProbe& probe);

// Plain C++ twin of kernels/stereo_refinement.cl, double precision.

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
/// `left_patches`: the side patches of the left edges, see reference/edge_descriptions.hpp.
///
/// Neighbours on one curve shift to the same position. Among candidates within 0.5 px, the one with the most similar
/// sides is refined and represents the others, which keep their positions.
RefinedCandidates stereo_refinement(const ImageView& left_image, const ImageView& right_image,
                                    const std::vector<std::int8_t>& left_patches, const EdgeSet& left,
                                    const EdgeSet& right, const EpipolarGeometry& geometry,
                                    const Candidates& candidates, const StereoConfig& config, double patch_offset,
                                    CandidateScores& scores);

// Plain C++ twin of kernels/stereo_clusters.cl.

using quadedge::StereoClusters;

/// Clusters the living candidates along their epipolar line (doc/method.md section 3, 8c).
///
/// The most similar member represents its cluster, because the centroid of the paper misses all members where two
/// curves are within a pixel (terrace_2s: 96.3 % recall and precision instead of 98.2 %).
StereoClusters stereo_clusters(const Candidates& candidates, const CandidateScores& scores,
                               const RefinedCandidates& refined, const EdgeSet& right);

// Plain C++ twin of kernels/stereo_relaxation.cl.

/// Result of the neighbours' votes.
struct StereoRelaxation {
  std::vector<double> belief;        ///< per cluster; those of an edge that reach filter 9 sum up to 1, others have 0
  std::vector<std::int32_t> chosen;  ///< cluster per left edge, -1: none
  RelaxationTally tally;             ///< of the vote without the coarse disparity
  std::vector<double> score;         ///< per left edge: similarity of its cluster, and what its support counts
};

/// Neighbouring edges vote on which cluster an edge takes (doc/method.md section 3, filters 9 and 10).
/// `width` x `height`: of the left image [px]; `coarse_disparity`: of the same pair, null: none.
StereoRelaxation stereo_relaxation(const StereoClusters& clusters, const EdgeSet& left,
                                   const EpipolarGeometry& geometry, int width, int height, const StereoConfig& config,
                                   const CoarseDisparity* coarse_disparity = nullptr);

// Plain C++ twin of kernels/stereo_mutual.cl.

/// Appends left edge i with its cluster c, but for the scale-space shift.
void append(const EdgeSet& left, std::size_t i, const StereoClusters& clusters, std::size_t c,
            const EpipolarGeometry& geometry, StereoEdges& edges);

/// Keeps a left edge if the best left edge of its right edge, by the score of the relaxation, is itself or lies within
/// `mutual_radius` on the same curve, and collects the survivors in the order of their left edges.
///
/// Third-order edges hold about two tokens per pixel in either image, so neighbouring left edges can correctly match
/// the same right token at different points of their curve. Requiring unique right edges (`mutual_radius` = 0) would
/// remove a fifth of the result for hardly any gain in precision (doc/method.md section 3).
StereoEdges stereo_mutual(const StereoClusters& clusters, const StereoRelaxation& relaxation, const EdgeSet& left,
                          const EpipolarGeometry& geometry, const StereoConfig& config);

}  // namespace quadedge::reference
