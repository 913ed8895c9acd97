#pragma once
/// \file image_delay.hpp  Right images that show another moment than the left ones they are paired with, by whole
/// frames.

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "quadedge/image.hpp"
#include "rig/corner_matching.hpp"

namespace quadedge::rig {

/// By how many frames the right images are late, and how well the images fit then.
struct ImageDelay {
  int frames = 0;           ///< negative: the left images are late
  double on_line = 0;       ///< fraction of the corners that lie on their epipolar lines with this delay
  double on_line_here = 0;  ///< the same in the images as they are paired
};

/// Range of delays, in frames, of one camera or the other.
struct DelaySizes {
  static constexpr int kMost = 7;
  int least = 1, most = kMost;
};

/// Keeps the last pairs. If many corners of a frame leave their lines, the partner of its images is looked for among
/// the neighbours: a left image of the last frames for the right image, or the other way round.
class ImageDelayFinder {
 public:
  /// Whether some delay can still be seen by the frames that follow the start.
  bool is_at_start() const { return count_ <= DelaySizes::kMost; }
  int frames() const { return count_; }  ///< kept so far

  /// Looks for a partner of the images of the next frame. \returns the delay with which this frame's corners lie on
  /// their lines while they do not as they are paired; nothing if no delay clearly fits better
  std::optional<ImageDelay> find(const CornerMatcher& matcher, const StereoFrame& frame, double max_disparity,
                                 DelaySizes sizes = {}) const;
  /// How well this frame fits with a delay that is known; nothing if it fits as paired, as it does at rest, and while
  /// too few frames are kept.
  std::optional<ImageDelay> measure(const CornerMatcher& matcher, const StereoFrame& frame, double max_disparity,
                                    int delay) const;
  /// Keeps copies of the frame's images, in place of the oldest ones.
  void keep(const StereoFrame& frame);

 private:
  struct Pair {
    Image left, right;
  };
  /// The pair that a delay makes of the frame and a frame before it; nothing if that is not kept.
  std::optional<StereoFrame> delayed(const StereoFrame& frame, int delay) const;

  std::vector<Pair> kept_;  ///< the latest first
  int count_ = 0;
};

/// Which delays a frame is examined for: all as soon as the images fit worse; while they can be tracked all the same,
/// those of one size per frame, since each takes a search, in rounds that become rarer.
class DelayRounds {
 public:
  /// The delays due in the next frame, called for every frame; an empty range between rounds.
  DelaySizes next_frame();
  /// Adds whether one of them was found, and whether the frame is lost if not: then all are due again soon.
  void add(bool is_found, bool is_lost);
  /// The images fit worse than before.
  void hasten();

 private:
  bool is_urgent_ = true;
  int size_ = 1, wait_ = 0, period_ = 0;
};

/// What successive frames say of the delay. Forgets it once enough of them in a row fit as they are paired: a pair that
/// a driver once mixed up must not cost frames hours later.
class DelayVotes {
 public:
  /// Adds what a frame says.
  void add(const std::optional<ImageDelay>& found);
  /// The delay on which enough frames agree, the last such one; nothing before.
  std::optional<int> decided() const { return decided_; }

 private:
  std::map<int, int> votes_;
  int frames_without_ = 0;  ///< since one was found
  std::optional<int> decided_;
};

}  // namespace quadedge::rig
