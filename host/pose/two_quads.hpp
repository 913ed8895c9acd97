#pragma once
/// \file two_quads.hpp  Proposition 2: the motion of a pair of quads (paper section 4).

#include <Eigen/Geometry>
#include <optional>

#include "pose/constraints.hpp"

namespace quadedge::pose {

/// The motion that maps the previous pair to the current one: e1 = D / |D|, e2 = the part of T1 orthogonal to e1, e3 =
/// e1 x e2, B = [e1 e2 e3] before and B_bar after, R = B_bar B^T. The translation maps midpoint to midpoint, which
/// halves the effect of one point's error; the paper's Gamma_bar_1 - R Gamma_1 uses one point only. (A least-squares
/// rotation over D, T1 and T2 with equal weights is worse, because D is known far better than a tangent in space: on
/// generated quads of a car's rig, the median error elsewhere in the image is 39 px against 28 px here.) Points in
/// metres in the left camera frames, tangents of unit length. Exact for exact pairs; for noisy ones R is still
/// orthonormal with determinant +1. Unique unless D is parallel to T1; coplanar vectors are permitted.
/// \param max_cosine |cos(D, T1)| above which the pair counts as degenerate, before or after
/// \returns current_from_previous, or nothing if D is zero or parallel to T1; the roles of the quads can then be
/// swapped
std::optional<Eigen::Isometry3d> solve_two_quads(const OrientedPair& previous, const OrientedPair& current,
                                                 double max_cosine);

}  // namespace quadedge::pose
