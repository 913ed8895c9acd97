#pragma once
/// \file quad_pairs.hpp  Evaluates pairs of quads under the constraints of the paper's Equation 9: Table 3, Figure 6
/// and Figure 7.

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "evaluation/cues.hpp"
#include "pose/quads.hpp"
#include "pose/two_quads.hpp"

namespace quadedge::evaluation {

/// Rows of Table 3: all pairs of quads, then the constraints of the paper's Equation 9 in succession.
inline constexpr std::array<const char*, 7> kConstraintNames = {
    "all pairs",          "length of D",    "angle of D and T1", "angle of D and T2",
    "angle of T1 and T2", "D not along T1", "handedness"};

/// Element k: the pairs of quads that satisfy constraints 1 to k. Veridical: both quads are veridical.
struct ConstraintCounts {
  std::int64_t pairs = 0, veridical = 0;
};
using ConstraintTable = std::array<ConstraintCounts, kConstraintNames.size()>;

/// Deviation of a motion from the true one: E = truth^-1 estimate.
struct MotionError {
  double rotation_deg = 0, translation_m = 0;
};
MotionError motion_error(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth);

/// Median errors of the motions obtained from single pairs (Proposition 2), over the pairs that satisfy constraints 1
/// to k, in element k. NaN if too few pairs give a motion.
using PairAccuracy = std::array<MotionError, kConstraintNames.size()>;

/// Measurements of the pairs of one frame.
struct PairMeasurement {
  ConstraintTable table{};
  PairAccuracy accuracy{};
};

/// Samples pairs of the quads in `usable` uniformly.
/// \param veridical one entry per quad
/// \param current_from_previous the true motion
/// \param cues receives the distributions of the constraints
PairMeasurement measure_pairs(const pose::QuadObservations& quads, const std::vector<std::size_t>& usable,
                              const std::vector<std::uint8_t>& veridical, std::uint64_t seed,
                              const Eigen::Isometry3d& current_from_previous, std::vector<CueDistribution>& cues);
inline constexpr int kDrawnPairs = 200000;
/// Maximum and minimum number of motions for a median.
inline constexpr std::size_t kMostMotions = 2000, kFewestMotions = 50;

/// Quantities that constraints 1 to 5 compare with their thresholds, in the units of CueDistribution;
/// check_constraints() passes values below the first four and above the fifth threshold. NaN for coincident points.
std::array<double, 5> constraint_values(const pose::OrientedPair& previous, const pose::OrientedPair& current);

}  // namespace quadedge::evaluation
