#pragma once
/// \file constraints.hpp  The six constraints on a pair of quads with a common motion (paper Equation 9).

#include <array>

#include "pose/oriented_point.hpp"
#include "quadedge/config.hpp"

namespace quadedge::pose {

/// Two oriented points of the same time; D = second.point - first.point.
struct OrientedPair {
  OrientedPoint first, second;
};

/// Thresholds of PoseConfig, converted to the quantities that are compared.
struct ConstraintLimits {
  explicit ConstraintLimits(const PoseConfig& config);
  double length, angle, tangent;  ///< relative length, differences of cosines
  double max_cosine;              ///< D and T1 count as parallel if |cos(D, T1)| exceeds this
  double determinant;             ///< of unit vectors
};

/// Outcome of each constraint of Equation 9; all quantities are independent of scale.
struct ConstraintCheck {
  /// [0] relative difference of |D|, divided by the previous |D|; [1], [2] signed cosines between D and T1, T2; [3]
  /// signed T1 . T2; [4] D is not parallel to T1 before and after, or else not parallel to T2, with the roles of the
  /// quads swapped; [5] det(D / |D|, T1, T2) has the same sign, if both magnitudes are large enough.
  /// Only the sign of the determinant is compared, because [0] to [3] imply its magnitude.
  std::array<bool, 6> passed{};
  bool swapped = false;  ///< [4] holds only with the second quad in the role of the first
  bool all() const { return passed[0] && passed[1] && passed[2] && passed[3] && passed[4] && passed[5]; }
};

/// Checks all six constraints. If the two points coincide (|D| = 0 before or after), every constraint that uses D
/// fails.
ConstraintCheck check_constraints(const OrientedPair& previous, const OrientedPair& current,
                                  const ConstraintLimits& limits);

}  // namespace quadedge::pose
