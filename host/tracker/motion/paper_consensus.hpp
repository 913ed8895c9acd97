#pragma once
/// \file paper_consensus.hpp  The pose as in section 6 of the paper: RANSAC over pairs of quads, each hypothesis
/// validated against all quads. Sampling and number of hypotheses are the code's.

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/oriented_point.hpp"
#include "motion/quads.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge::paper {

// Proposition 1: the motions compatible with one quad (paper section 4, Equations 4 to 7).

/// The shortest rotation from unit vector `from` to unit vector `to` (Equation 6), accurate up to and including to =
/// -from, for which it is a half turn about some axis orthogonal to `from`.
Eigen::Matrix3d align(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// One member of the family of motions that map `previous` to `current`, both points (metres) and unit tangents:
///   R(theta) = Rot(current.tangent, theta) align(previous.tangent, current.tangent),
///   T(theta) = Gamma_bar - R(theta) Gamma.
/// The translation uses the points; the tangents printed in Equation 7 cannot determine one. \param theta [rad]
/// \returns current_from_previous, left cameras
Eigen::Isometry3d motion_of_one_quad(const pose::OrientedPoint& previous, const pose::OrientedPoint& current,
                                     double theta);

/// Proposition 2 as printed: the rotation of solve_two_quads(), the translation from the first point.
/// \returns current_from_previous; nothing for a pair that Equation 9 excludes
std::optional<Eigen::Isometry3d> motion_of_two_quads(const pose::QuadObservations& quads, std::size_t first,
                                                     std::size_t second);

/// Marks the quads whose current left point lies within `distance` px of the projected previous point and whose current
/// left tangent is within 10 degrees of the projected one, modulo half a turn. \returns their number
int find_inliers(const pose::QuadObservations& quads, const PinholeCamera& left,
                 const Eigen::Isometry3d& current_from_previous, double distance, std::vector<std::uint8_t>& inlier);

struct PaperConsensus {
  std::optional<Eigen::Isometry3d> current_from_previous;  ///< nothing if no pair satisfies Equation 9
  std::vector<std::uint8_t> inlier;                        ///< one per quad
  int inliers = 0, hypotheses = 0, draws = 0;
};

/// The hypothesis with most inliers. Pairs are drawn uniformly from the 70 % of the quads whose previous edge owns the
/// fewest quads; pose.max_draws bounds their number, since draws that Equation 9 excludes are no hypotheses.
PaperConsensus find_paper_consensus(const pose::QuadObservations& quads, const PinholeCamera& left,
                                    const PoseConfig& config, std::uint64_t seed);

}  // namespace quadedge::paper
