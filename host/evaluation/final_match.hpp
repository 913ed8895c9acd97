#pragma once
/// \file final_match.hpp  Final stereo edges of a frame with ground truth, as drawn in the paper's Figures 8 and 9.

#include <array>
#include <cstdint>
#include <vector>

#include "quadedge/image.hpp"

namespace quadedge::evaluation {

/// Class of a final stereo edge with a known true position.
enum class MatchClass {
  correct,     ///< within MatchingTolerance::position of the true position
  inaccurate,  ///< farther away, but within MatchingTolerance::wrong
  wrong,       ///< beyond MatchingTolerance::wrong
  occluded,    ///< the edge is not visible in the right view, so that its match must be another edge
};
inline constexpr std::array<const char*, 4> kMatchClassNames = {"correct", "inaccurate", "wrong", "occluded"};
using MatchClassCounts = std::array<std::int64_t, kMatchClassNames.size()>;

/// A final stereo edge [px, rad] and the true position of its left edge in the right image.
struct FinalMatch {
  float left_x, left_y, left_direction;
  float right_x, right_y, right_direction;
  float true_x, true_y;
  MatchClass kind;
};

/// Data for the drawing of one frame.
struct DrawnFrame {
  int number = 0;
  Image left, right;
  std::vector<FinalMatch> matches;
};

}  // namespace quadedge::evaluation
