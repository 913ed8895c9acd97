#pragma once
/// \file quad_pairs.hpp  Pairs of quads under the constraints of the paper's Equation 9: Table 3, Figure 6 and
/// Figure 7.

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "evaluation/cue_distribution.hpp"
#include "pose/constraints.hpp"
#include "pose/quads.hpp"

namespace quadedge::evaluation {

/// Rows of Table 3: all pairs of quads, then the constraints of the paper's Equation 9 one after another.
inline constexpr std::array<const char*, 7> kConstraintNames = {
    "baseline",           "length of D",    "angle of D and T1", "angle of D and T2",
    "angle of T1 and T2", "D not along T1", "handedness"};

/// Pairs of quads that fulfil constraints 1 to `order`. Veridical: both quads are.
struct ConstraintCounts {
  std::int64_t pairs = 0, veridical = 0;
};
using ConstraintTable = std::array<ConstraintCounts, kConstraintNames.size()>;

/// How far a motion is from the true one: E = truth^-1 estimate.
struct MotionError {
  double rotation_deg = 0, translation_m = 0;
};
MotionError motion_error(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth);

/// The motions that single pairs give (Proposition 2), over the pairs that fulfil constraints 1 to `order`: medians of
/// their errors. NaN where too few pairs give a motion.
using PairAccuracy = std::array<MotionError, kConstraintNames.size()>;

/// What was measured of the pairs of one frame.
struct PairMeasurement {
  ConstraintTable table{};
  PairAccuracy accuracy{};
};

/// Draws pairs of the quads in `usable` uniformly.
/// \param veridical one entry per quad
/// \param current_from_previous the true motion
/// \param cues the distributions of the constraints are added here
PairMeasurement measure_pairs(const pose::QuadObservations& quads, const std::vector<std::size_t>& usable,
                              const std::vector<std::uint8_t>& veridical, const PoseConfig& config, std::uint64_t seed,
                              const Eigen::Isometry3d& current_from_previous, std::vector<CueDistribution>& cues);
inline constexpr int kDrawnPairs = 200000;
/// Motions that a median is taken over: at most, at least.
inline constexpr std::size_t kMostMotions = 2000, kFewestMotions = 50;

/// What constraints 1 to 5 compare with their thresholds, in the units of CueDistribution; check_constraints() passes
/// exactly what is below the first four and above the fifth. NaN for points on one spot.
std::array<double, 5> constraint_values(const pose::OrientedPair& previous, const pose::OrientedPair& current);

}  // namespace quadedge::evaluation
