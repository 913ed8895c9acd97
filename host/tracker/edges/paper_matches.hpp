#pragma once
/// \file paper_matches.hpp  What the cascades of the paper leave after their filters, for taps.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/candidate_lists.hpp"

namespace quadedge::paper {

/// Position [px] and direction [rad] of an edge.
struct Place {
  float x = 0, y = 0, direction = 0;
};

/// Candidates that count as one edge.
struct Cluster {
  Place centre;  ///< centroid of the members, direction weighted by a Gaussian of the distance from it
  std::vector<std::int32_t> members;  ///< targets, the nearest to the centroid first
};

/// Every left edge's candidates after each filter in stereo. Row i is left edge i.
struct StereoMatching {
  Candidates candidates;             ///< after epipolar proximity, limited disparity and orientation
  CandidateScores scores;            ///< and the decisions of the filters on them
  StereoClusters clusters;           ///< refined and clustered; similarity: NCC at the representative
  std::vector<std::int32_t> chosen;  ///< index of the best cluster, -1: none
};

/// Candidates in one image after each filter in time. Row i is stereo edge i of the earlier frame.
struct SideMatching {
  Candidates candidates;                       ///< after displacement and orientation
  CandidateScores scores;                      ///< and the decisions of the filters on them
  std::vector<std::vector<Cluster>> clusters;  ///< of the refined candidates, per row
};

/// Two clusters that hold the same current stereo edge: the circle is closed.
struct Quad {
  std::size_t left, right;  ///< numbers of the clusters in their rows
  std::int32_t edge;        ///< of the edges that both hold, the nearest to the left centroid
};

/// The quads of one row, at most one per pair of clusters.
inline std::vector<Quad> close_loop(const std::vector<Cluster>& left, const std::vector<Cluster>& right) {
  std::vector<Quad> quads;
  for (std::size_t l = 0; l < left.size(); ++l) {
    for (std::size_t r = 0; r < right.size(); ++r) {
      const auto& others = right[r].members;
      const auto shared = std::find_if(left[l].members.begin(), left[l].members.end(), [&](std::int32_t edge) {
        return std::find(others.begin(), others.end(), edge) != others.end();
      });
      if (shared != left[l].members.end()) quads.push_back({l, r, *shared});
    }
  }
  return quads;
}

}  // namespace quadedge::paper
