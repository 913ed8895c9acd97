#pragma once
/// \file ransac.hpp  Consensus search: two-quad samples, scored in both current images and optimised locally
/// (doc/method.md section 6).

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "motion/pose_constants.hpp"
#include "motion/sample_fit.hpp"
#include "motion/sampling_order.hpp"
#include "motion/scoring.hpp"

namespace quadedge::pose {

/// The best motion found by sampling.
struct Consensus {
  bool found = false;  ///< false: no sample passed the constraints, and no initial hypothesis was given
  Eigen::Isometry3d current_from_previous = Eigen::Isometry3d::Identity();  ///< left cameras, metres
  double cost = 1;                                                          ///< truncated_cost() over the scored quads
  int hypotheses = 0;  ///< motions scored, including an initial hypothesis
  int draws = 0;       ///< pairs drawn, including rejected ones
};

/// Two quads that were drawn, and the motion that they give, if they give one.
struct PairSample {
  std::size_t first, second;
  std::optional<Eigen::Isometry3d> motion;
};

/// Buffers of the fit of one pair.
struct PairWorkspace {
  std::vector<SampleTerm> terms = std::vector<SampleTerm>(2);
  SampleWorkspace fit;
};

/// Buffers of find_consensus(), kept between calls.
struct ConsensusWorkspace {
  SubsetWorkspace subset;
  std::vector<SamplingOrder::Entry> order;
  std::vector<std::int32_t> scored_rows, preview_rows;
  ScoringArrays scored, preview;
  std::vector<SampleTerm> preview_terms;
  std::vector<PairSample> drawn;
  std::vector<PairWorkspace> pairs;
  std::vector<std::int32_t> inlier_rows;
  std::vector<std::uint8_t> mask;
  SampleWorkspace fit;
};

/// Samples pairs of quads, best first (SamplingOrder; the pool grows with the draws, as in PROSAC). A pair that passes
/// the six constraints is solved, fitted with the noise of its tangents (fit_sample()) and scored on kPreviewQuads
/// quads, taken evenly from cells of config.scoring_cell px, so that a motion is judged by the area that agrees with
/// it. A sample that beats all previous ones is optimised locally over its inliers, with a distance that decreases from
/// config.local_optimisation_widening times to config.inlier_distance, and compared over kScoringQuads. The
/// search ends after kConfidence, max_hypotheses or max_draws; rejected draws count.
/// \param seed seed of all random numbers; the same seed gives identical bits
/// \param disparity_error see RigEstimate [px]
/// \param initial a hypothesis that is scored first (a predicted or frame-to-frame pose), current_from_previous
Consensus find_consensus(const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config,
                         std::uint64_t seed, const std::optional<Eigen::Isometry3d>& initial,
                         ConsensusWorkspace& workspace, double disparity_error = 0);

}  // namespace quadedge::pose
