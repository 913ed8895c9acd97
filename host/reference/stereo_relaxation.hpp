#pragma once
/// \file stereo_relaxation.hpp  Plain C++ twin of kernels/stereo_relaxation.cl.

#include "common/disparity_range.hpp"
#include "common/epipolar_geometry.hpp"
#include "reference/coarse_disparity.hpp"
#include "reference/stereo_clusters.hpp"

namespace quadedge::reference {

/// Result of the neighbours' votes.
struct StereoRelaxation {
  std::vector<double> belief;        ///< per cluster; those of an edge that reach filter 9 sum up to 1, others have 0
  std::vector<std::int32_t> chosen;  ///< cluster per left edge, -1: none
  RelaxationTally tally;             ///< of the vote without the coarse disparity
  std::vector<double> score;         ///< per left edge: similarity of its cluster, and what its support counts
};

/// Neighbouring edges vote on which cluster an edge takes (doc/method.md section 3, filters 9 and 10).
/// `width` x `height`: of the left image [px]; `witness`: of the same pair, null: none.
StereoRelaxation stereo_relaxation(const StereoClusters& clusters, const EdgeSet& left,
                                   const EpipolarGeometry& geometry, int width, int height, const StereoConfig& config,
                                   const CoarseDisparity* witness = nullptr);

}  // namespace quadedge::reference
