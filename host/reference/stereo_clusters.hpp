#pragma once
/// \file stereo_clusters.hpp  Plain C++ twin of kernels/stereo_clusters.cl.

#include "quadedge/config.hpp"
#include "reference/stereo_refinement.hpp"

namespace quadedge::reference {

/// Representatives of clusters of candidates. Row i (left edge) owns first[i] .. first[i + 1].
struct StereoClusters {
  std::vector<std::int32_t> first;
  std::vector<double> position;      ///< on the left edge's epipolar line [px from the point at infinity]
  std::vector<double> direction;     ///< [rad], weighted mean of the members
  std::vector<std::int32_t> anchor;  ///< right edge of the most similar member; among equals the first in scan order
  std::vector<double> similarity;    ///< of that member
};

/// Clusters the living candidates along their epipolar line (doc/method.md section 3, 8c).
///
/// The most similar member represents its cluster, because the centroid of the paper misses all members where two
/// curves are within a pixel (terrace_2s: 96.3 % recall and precision instead of 98.2 %).
StereoClusters stereo_clusters(const Candidates& candidates, const CandidateScores& scores,
                               const RefinedCandidates& refined, const EdgeSet& right);

}  // namespace quadedge::reference
