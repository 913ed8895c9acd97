#pragma once
/// \file coarse_gate.hpp  Decides in which frames a coarse disparity is consulted. doc/method.md section 3.

#include "common/disparity_range.hpp"
#include "quadedge/config.hpp"

namespace quadedge::frontend {

/// Is open for frames in which neighbours leave stereo.coarse_ties of the edges undecided, and never for a rig that is
/// not rectified. A frame starts as the one before it ended and is searched again if that was wrong, so that its result
/// does not depend on the frames before it.
class CoarseGate {
 public:
  CoarseGate(const StereoConfig& config, bool is_rectified)
      : limit_(is_rectified && config.relaxation_rounds > 0 ? config.coarse_ties : 1) {}

  bool is_open() const { return is_open_; }
  /// Whether the frame was searched as it needs. If not, the gate is as it should be now, and the frame is to be
  /// searched again; for the same tally the second answer is true.
  bool suffices(const RelaxationTally& tally) {
    const bool was_open = is_open_;
    is_open_ = limit_ < 1 && tally.undecided >= limit_ * tally.edges;
    return was_open == is_open_;
  }

 private:
  double limit_;
  bool is_open_ = false;
};

}  // namespace quadedge::frontend
