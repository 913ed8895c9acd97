#pragma once
/// \file stereo_clusters.hpp  Plain C++ twin of kernels/stereo_clusters.cl.

#include "quadedge/config.hpp"
#include "reference/stereo_refinement.hpp"

namespace quadedge::reference {

/// Representatives of clusters of candidates. Row i (left edge) owns first[i] .. first[i + 1].
struct StereoClusters {
  std::vector<std::int32_t> first;
  std::vector<double> place;          ///< on the left edge's epipolar line [px from the point at infinity]
  std::vector<double> direction;      ///< [rad], with the anchor's polarity
  std::vector<std::int32_t> anchor;   ///< the right edge nearest to the centroid, of equally near ones the first in scan order
  std::vector<double> ncc;            ///< of the freshly cut patches; filled by stereo_best()
};

/// Clusters the living candidates along their epipolar line (SPEC 8c).
StereoClusters stereo_clusters(const Candidates& candidates, const CandidateScores& scores, const std::vector<double>& places,
                               const EdgeSet& right, const StereoConfig& config);

/// Computes `clusters.ncc` and returns the best cluster of every left edge, -1 for none (SPEC filters 9 and 10).
std::vector<std::int32_t> stereo_best(StereoClusters& clusters, const EdgeSet& left, const std::vector<float>& left_patches,
                                      const ImageView& right_image, const stages::EpipolarGeometry& geometry,
                                      const StereoConfig& config, double patch_offset);

/// Keeps a left edge if the best left edge of its right edge is itself or lies within `mutual_radius` on the same curve, and
/// collects the survivors in the order of their left edges.
///
/// Strict uniqueness of the right edge's index would halve the result for nothing: third-order edges hold about two tokens per
/// pixel in either image, so neighbouring left edges rightly meet the same right token, at different points of their curve.
StereoEdges stereo_mutual(const StereoClusters& clusters, const std::vector<std::int32_t>& best, const EdgeSet& left,
                          const stages::EpipolarGeometry& geometry, const StereoConfig& config);

}  // namespace quadedge::reference
