#pragma once
/// \file ransac.hpp  A consensus of quads: two-quad samples, scored in both later images, polished locally (SPEC section 6).

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "pose/residuals.hpp"

namespace quadedge::pose {

/// The best motion that sampling found.
struct Consensus {
  bool found = false;          ///< false: no sample passed the constraints and no initial guess was given
  Eigen::Isometry3d current_from_previous = Eigen::Isometry3d::Identity();
  double cost = 1;             ///< truncated_cost() over all quads
  int hypotheses = 0;          ///< motions scored, an initial guess included
  int draws = 0;               ///< pairs drawn, rejected ones included
};

/// Samples pairs of quads, best first (fewest rivals, then highest NCC, then lowest index; the pool grows with the draws as in
/// PROSAC), solves each pair that passes the six constraints and whose quads lie apart in the image, and scores it on a fixed random
/// subset of config.preview quads. A pair's tangents, and with them the rotation about the line through its points, carry the
/// error of two directions, so a correct sample is some pixels off elsewhere: raw samples are compared with the inlier distance
/// widened by config.local_widening, and each that beats all raw samples before it is optimised locally: fits over its inliers in the
/// subset, the distance narrowing back to config.inlier_distance. Optimised motions are compared over all quads.
/// Stops when another pair of inliers has been drawn with config.confidence, at config.max_hypotheses, or at config.max_draws draws;
/// rejected draws count, so fewer than two quads, or quads of which no pair passes, end the search at once or after the draws.
/// \param seed all randomness; the same seed gives the same bits.
/// \param initial another hypothesis, scored first (a predicted pose, the frame-to-frame pose), current_from_previous.
Consensus find_consensus(const std::vector<FitTerm>& terms, const QuadObservations& quads, const StereoRig& rig,
                         const PoseConfig& config, std::uint64_t seed, const std::optional<Eigen::Isometry3d>& initial);

}  // namespace quadedge::pose
