#pragma once
/// \file ransac.hpp  Consensus search: two-quad samples, scored in both current images and optimised locally
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

/// The best motion found by sampling.
struct Consensus {
  bool found = false;  ///< false: no sample passed the constraints, and no initial hypothesis was given
  Eigen::Isometry3d current_from_previous = Eigen::Isometry3d::Identity();  ///< left cameras, metres
  double cost = 1;                                                          ///< truncated_cost() over the scored quads
  int hypotheses = 0;  ///< motions scored, including an initial hypothesis
  int draws = 0;       ///< pairs drawn, including rejected ones
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

/// Samples pairs of quads, best first (see SamplingOrder; the pool grows with the draws, as in PROSAC). Each pair that
/// passes the six constraints and whose quads are far enough apart in the image is solved and scored on a fixed random
/// subset of kPreviewQuads, taken evenly from the image cells of config.scoring_cell px: a motion is judged by the area
/// whose quads agree with it, not by the number of edges in that area (a moving object may contain most of them).
///
/// Proposition 2 determines the rotation about the line through the pair from one tangent in space, whose depth slope
/// is the least certain quantity of an edge. fit_sample(), which models this uncertainty, is therefore run on the two
/// quads. (For generated quads with a direction noise of 0.6 degrees, it reduces the median error elsewhere in the
/// image from 28 to 7 px.) A correct sample is still several pixels off elsewhere. Samples are therefore compared with
/// an inlier distance widened by config.local_optimisation_widening, and each sample that beats all previous ones is
/// optimised locally by fits over its inliers in the subset, with a distance that decreases to config.inlier_distance.
/// Optimised motions are compared over config.scoring_quads, selected in the same way.
/// The search ends when a further pair of inliers has been drawn with probability config.confidence, after
/// config.max_hypotheses hypotheses, or after config.max_draws draws. Rejected draws count, so that the search also
/// ends if there are fewer than two quads or no pair passes.
/// \param seed seed of all random numbers; the same seed gives identical bits
/// \param initial a hypothesis that is scored first (a predicted or frame-to-frame pose), current_from_previous
Consensus find_consensus(const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config,
                         std::uint64_t seed, const std::optional<Eigen::Isometry3d>& initial,
                         ConsensusWorkspace& workspace);

}  // namespace quadedge::pose
