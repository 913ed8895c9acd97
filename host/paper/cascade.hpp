#pragma once
/// \file cascade.hpp  What the cascades in stereo and in time share: scores of candidates and the filters on them, and
/// clusters of refined candidates (paper section 5.1).

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/filter_limits.hpp"
#include "paper/side_patches.hpp"
#include "reference/candidate_filters.hpp"

namespace quadedge::paper {

/// Both descriptions of a set of edges: SIFT as in reference/sift.hpp.
struct Described {
  std::vector<SidePatches> patches;
  std::vector<std::uint8_t> sift;
};

Described describe(const ImageView& image, const Picture& picture, const EdgePositionsView& edges, double offset);

/// Smallest difference of two directions modulo half a turn [rad]; both in (-pi, pi].
float line_angle_between(float a, float b);

/// NCC, SIFT distance and the decisions of the four filters on them for every candidate. Rows are edges of `a`, targets
/// edges of `b`. \param all_scores SIFT distances also of candidates that the NCC rejects, for a tap
reference::CandidateScores judge(const reference::Candidates& candidates, const Described& a, const Described& b,
                                 const FilterLimits& limits, bool all_scores);

/// A refined candidate.
struct Hypothesis {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< [px]
  float direction = 0;                                 ///< of the edge that was refined [rad]
  std::int32_t target = 0;                             ///< its number
};

/// Candidates that count as one edge.
struct Cluster {
  Place centre;  ///< centroid of the members, direction weighted by a Gaussian of the distance from it
  std::vector<std::int32_t> members;  ///< targets, the nearest to the centroid first
};

/// Agglomerative clustering with single linkage: in the order of the list, the first member that has a nearest one of
/// another cluster within a pixel and 20 degrees joins it, up to ten members, until none does.
std::vector<Cluster> clusters_of(const std::vector<Hypothesis>& hypotheses);

}  // namespace quadedge::paper
