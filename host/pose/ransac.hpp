#pragma once
/// \file ransac.hpp  A consensus of quads: two-quad samples, scored in both current images, optimised locally
/// (doc/method.md section 6).

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "pose/sample_fit.hpp"
#include "pose/sampling_order.hpp"
#include "pose/scoring.hpp"
#include "pose/scoring_subset.hpp"

namespace quadedge::pose {

/// Quads on which all hypotheses are compared: enough to find the promising ones, which pose.scoring_quads then judge.
constexpr std::size_t kPreviewQuads = 512;

/// The best motion that sampling found.
struct Consensus {
  bool found = false;  ///< false: no sample passed the constraints and no initial guess was given
  Eigen::Isometry3d current_from_previous = Eigen::Isometry3d::Identity();  ///< left cameras, metres
  double cost = 1;                                                          ///< truncated_cost() over the scored quads
  int hypotheses = 0;  ///< motions scored, an initial guess included
  int draws = 0;       ///< pairs drawn, rejected ones included
};

/// Buffers of find_consensus(), kept between calls.
struct ConsensusWorkspace {
  SubsetWorkspace subset;
  std::vector<SamplingOrder::Entry> order;
  std::vector<std::int32_t> scored_rows, preview_rows;
  ScoringArrays scored, preview;
  std::vector<SampleTerm> preview_terms, pair_terms = std::vector<SampleTerm>(2);
  std::vector<std::int32_t> inlier_rows;
  std::vector<std::uint8_t> mask;
  SampleWorkspace fit;
};

/// Samples pairs of quads, best first (see SamplingOrder; the pool grows with the draws as in PROSAC), solves each pair
/// that passes the six constraints and whose quads lie apart in the image, and scores it on a fixed random subset of
/// kPreviewQuads, as many from each cell of config.scoring_cell px as it has: a motion is judged by the area
/// whose quads agree with it, not by the edges that this area happens to hold (a moving thing may be covered with most
/// of them).
///
/// Proposition 2 takes the rotation about the line through the pair from one tangent in space, whose depth slope is the
/// least certain thing about an edge; fit_sample() on the two quads alone, which knows that, follows it. (On generated
/// quads with a direction noise of 0.6 degrees it takes the median error elsewhere in the image from 28 to 7 px.) A
/// correct sample is still some pixels off elsewhere: samples are compared with the inlier distance widened by
/// config.local_optimisation_widening, and each that beats all samples before it is optimised locally: fits over its
/// inliers in the subset, the distance narrowing back to config.inlier_distance. Optimised motions are compared over
/// config.scoring_quads, chosen likewise.
///
/// Stops when another pair of inliers has been drawn with config.confidence, at config.max_hypotheses, or at
/// config.max_draws draws; rejected draws count, so fewer than two quads, or quads of which no pair passes, end the
/// search at once or after the draws.
/// \param seed all randomness; the same seed gives the same bits
/// \param initial another hypothesis, scored first (a predicted pose, the frame-to-frame pose), current_from_previous
Consensus find_consensus(const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config,
                         std::uint64_t seed, const std::optional<Eigen::Isometry3d>& initial,
                         ConsensusWorkspace& workspace);

}  // namespace quadedge::pose
