#pragma once
/// \file image_delay.hpp  Right images that show another moment than the left ones they are paired with, by whole
/// frames.

#include <deque>
#include <map>
#include <string>
#include <utility>

#include "quadedge/image.hpp"
#include "rig/corner_matching.hpp"

namespace quadedge::rig {

/// Keeps the last pairs of a recording. If many corners of a pair leave their lines, the partner of its images is
/// looked for among the neighbours: a left image of the last pairs for the right image, or the other way round.
class ImageDelaySearch {
 public:
  static constexpr int kMost = 7;  ///< frames

  /// Adds the next pair. \param looks whether its partner is looked for, if its corners ask for that
  void add(const StereoRig& rig, const Image& left, const Image& right, double max_disparity, bool looks);
  /// The delay on which most of the pairs agree, at least two, in a sentence; empty without one.
  std::string text() const;

 private:
  /// Pairs that fit with a delay, and sums of the fractions of corners on their lines, with it and as paired.
  struct Votes {
    int pairs = 0;
    double on_line = 0, on_line_here = 0;
  };
  std::deque<std::pair<Image, Image>> kept_;  ///< left, right; the latest first
  std::map<int, Votes> votes_;  ///< of delays of the right images [frames]; negative: the left ones are late
  int doubted_ = 0;             ///< pairs whose partners were looked for among all neighbours
};

}  // namespace quadedge::rig
