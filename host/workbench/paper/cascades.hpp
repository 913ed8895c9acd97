#pragma once
/// \file cascades.hpp  The cascades of the paper in stereo (section 5.1, Table 1) and in time (section 5.2, Table
/// 2).

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/filter_limits.hpp"
#include "edges/paper_matches.hpp"
#include "geometry/epipolar_geometry.hpp"
#include "paper/side_patches.hpp"
#include "quadedge/config.hpp"
#include "reference/candidates.hpp"
#include "reference/stereo_matching.hpp"

namespace quadedge::paper {

// What the cascades in stereo and in time share: scores of candidates and the filters on them, and clusters of refined
// candidates (paper section 5.1).

/// Both descriptions of a set of edges: SIFT as in reference/edge_descriptions.hpp.
struct Described {
  std::vector<SidePatches> patches;
  std::vector<std::uint8_t> sift;
};

Described describe(const ImageView& image, const Picture& picture, const EdgePositionsView& edges, double offset);

/// Smallest difference of two directions modulo half a turn [rad]; both in (-pi, pi].
float line_angle_between(float a, float b);

/// NCC, SIFT distance and the decisions of the four filters on them for every candidate. Rows are edges of `a`, targets
/// edges of `b`. Plain C++ twin of kernels/paper_filters.cl. \param all_scores SIFT distances also of candidates that
/// the NCC rejects, for a tap
reference::CandidateScores judge(const reference::Candidates& candidates, const Described& a, const Described& b,
                                 const FilterLimits& limits, bool all_scores);

// Plain C++ twin of kernels/paper_clusters.cl.

/// A refined candidate.
struct Hypothesis {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< [px]
  float direction = 0;                                 ///< of the edge that was refined [rad]
  std::int32_t target = 0;                             ///< its number
};

/// Agglomerative clustering with single linkage: in the order of the list, the first member that has a nearest one of
/// another cluster within a pixel and 20 degrees joins it, up to ten members, until none does.
std::vector<Cluster> clusters_of(const std::vector<Hypothesis>& hypotheses);

// The stereo cascade of the paper (section 5.1, Table 1).

/// One image of a frame, and all of its edges.
struct View {
  Picture picture;
  EdgeSet edges;
  Described described;
};

/// \param geometry of the calibration; its orientation is that of filter 3, which compares modulo half a turn
/// \param all_scores see judge()
StereoMatching match_stereo(const View& left, const View& right, const EpipolarGeometry& geometry,
                            const StereoConfig& config, double patch_offset, bool all_scores);

/// The best clusters as stereo edges. Several left edges may share a right one, as in the code.
StereoEdges stereo_edges(const StereoMatching& matching, const EdgeSet& left, const EpipolarGeometry& geometry);

// The temporal cascade of the paper (section 5.2, Table 2): each image by itself, then quads.

/// The stereo edges of a frame as one of its cameras sees them.
struct StereoEdgesInView {
  const Picture& picture;
  EdgePositionsView edges;
  const Described& described;
  int width, height;  ///< of the image [px]
};

/// Current edges within `radius` px of the previous position whose direction differs by at most `orientation`, modulo
/// half a turn [rad]. `width` x `height`: of the current image [px].
reference::Candidates near_previous(const EdgePositionsView& before, const EdgePositionsView& now, int width,
                                    int height, double radius, double orientation);

/// Filters 1 to 8. \param all_scores see judge()
SideMatching match_side(const StereoEdgesInView& before, const StereoEdgesInView& now, const TemporalConfig& config,
                        const RefinementSettings& settings, bool all_scores);

/// Plain C++ twin of kernels/paper_quads.cl: all quads of two frames, in the order of the previous edges, of which each
/// may own several.
TemporalMatches quads_of(const SideMatching& left, const SideMatching& right);

}  // namespace quadedge::paper
