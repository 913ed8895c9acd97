#pragma once
/// \file two_quads.hpp  The motion of a pair of quads (Proposition 2, paper section 4), and the six constraints on a
/// pair with a common motion (paper Equation 9).

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "geometry/oriented_point.hpp"
#include "quadedge/config.hpp"

namespace quadedge::pose {

/// Two oriented points of the same time; D = second.point - first.point.
struct OrientedPair {
  OrientedPoint first, second;
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
ConstraintCheck check_constraints(const OrientedPair& previous, const OrientedPair& current);

/// The motion that maps the previous pair to the current one: e1 = D / |D|, e2 = the part of T1 orthogonal to e1, e3 =
/// e1 x e2, B = [e1 e2 e3] before and B_bar after, R = B_bar B^T. The translation maps midpoint to midpoint, which
/// halves the effect of one point's error; the paper's Gamma_bar_1 - R Gamma_1 uses one point only. Points in metres in
/// the left camera frames, tangents of unit length. Exact for exact pairs; for noisy ones R is still orthonormal.
/// \returns current_from_previous, or nothing if D is zero or parallel to T1 (kMinAngleDeg), before or after; the roles
/// of the quads can then be swapped
std::optional<Eigen::Isometry3d> solve_two_quads(const OrientedPair& previous, const OrientedPair& current);

/// The motion of two pairs that pass all six constraints. Swaps the quads if they hold only in the other roles.
std::optional<Eigen::Isometry3d> solve_constrained(OrientedPair& previous, OrientedPair& current);

}  // namespace quadedge::pose
