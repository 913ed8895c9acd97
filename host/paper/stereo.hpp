#pragma once
/// \file stereo.hpp  The stereo cascade of the paper (section 5.1, Table 1).

#include "common/epipolar_geometry.hpp"
#include "paper/cascade.hpp"
#include "quadedge/config.hpp"
#include "reference/stereo_clusters.hpp"

namespace quadedge::paper {

/// One image of a rig, and all of its edges.
struct View {
  Picture picture;
  EdgeSet edges;
  Described described;
};

/// Every left edge's candidates after each filter. Row i is left edge i.
struct StereoMatching {
  reference::Candidates candidates;    ///< after epipolar proximity, limited disparity and orientation
  reference::CandidateScores scores;   ///< and the decisions of the filters on them
  reference::StereoClusters clusters;  ///< refined and clustered; similarity: NCC at the representative
  std::vector<std::int32_t> chosen;    ///< index of the best cluster, -1: none
};

/// \param geometry of the calibration; its orientation is that of filter 3, which compares modulo half a turn
/// \param all_scores see judge()
StereoMatching match_stereo(const View& left, const View& right, const EpipolarGeometry& geometry,
                            const StereoConfig& config, double patch_offset, bool all_scores);

/// The best clusters as stereo edges. Several left edges may share a right one, as in the code.
StereoEdges stereo_edges(const StereoMatching& matching, const EdgeSet& left, const EpipolarGeometry& geometry);

}  // namespace quadedge::paper
