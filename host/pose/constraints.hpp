#pragma once
/// \file constraints.hpp  The six constraints that a pair of quads must fulfil to have a common motion (paper Equation
/// 9).

#include <array>

#include "pose/oriented_point.hpp"
#include "quadedge/config.hpp"

namespace quadedge::pose {

/// Two oriented points of the same time, D = second.point - first.point.
struct OrientedPair {
  OrientedPoint first, second;
};

/// Thresholds of PoseConfig in the form in which they are compared.
struct ConstraintLimits {
  explicit ConstraintLimits(const PoseConfig& config);
  double length, angle, tangent;  ///< no unit: relative length, differences of cosines
  double max_cosine;              ///< |cos(D, T1)| beyond this means parallel
  double determinant;             ///< of unit vectors
};

/// Each constraint of Equation 9 with its own verdict; all quantities are free of scale.
struct ConstraintCheck {
  /// [0] relative difference of |D|, over the previous |D|; [1], [2] signed cosines between D and T1, T2; [3] signed T1
  /// . T2; [4] D is not parallel to T1 before and after, or else not parallel to T2, with the quads in swapped roles;
  /// [5] the sign of det(D / |D|, T1, T2) is the same, where both magnitudes make it informative.
  /// The determinant is only a sign: where [0] to [3] hold its magnitude follows from them.
  std::array<bool, 6> passed{};
  bool swapped = false;  ///< [4] holds only with the second quad in the first one's role
  bool all() const { return passed[0] && passed[1] && passed[2] && passed[3] && passed[4] && passed[5]; }
};

/// Checks all six. Two points on one spot (|D| = 0 before or after) fail every constraint that needs D.
ConstraintCheck check_constraints(const OrientedPair& previous, const OrientedPair& current,
                                  const ConstraintLimits& limits);

}  // namespace quadedge::pose
