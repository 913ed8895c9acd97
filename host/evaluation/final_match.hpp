#pragma once
/// \file final_match.hpp  The final stereo edges of a frame beside the truth, as the paper's Figures 8 and 9 draw them.

#include <array>
#include <cstdint>
#include <vector>

#include "quadedge/image.hpp"

namespace quadedge::evaluation {

/// What the truth says about a final stereo edge whose true position is known.
enum class MatchClass {
  correct,     ///< within MatchingTolerance::position of the true position
  inaccurate,  ///< farther, but within MatchingTolerance::wrong
  wrong,       ///< farther still
  occluded,    ///< the right view cannot show the edge: whatever was matched is something else
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

/// Everything that a drawing of one frame needs.
struct DrawnFrame {
  int number = 0;
  Image left, right;
  std::vector<FinalMatch> matches;
};

}  // namespace quadedge::evaluation
