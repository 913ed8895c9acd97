#pragma once
/// \file coarse_gate.hpp  Decides in which frames a coarse disparity is consulted. doc/method.md section 3.

#include "common/coarse_search.hpp"
#include "quadedge/config.hpp"

namespace quadedge::frontend {

/// Opens in the frame in which neighbours leave stereo.coarse_ties of the edges undecided, and closes after
/// the first frame in which they leave fewer; never opens for a rig that is not rectified. Depends only on the frames
/// so far.
class CoarseGate {
 public:
  CoarseGate(const StereoConfig& config, bool is_rectified)
      : limit_(is_rectified && config.relaxation_rounds > 0 ? config.coarse_ties : 1) {}

  void start_frame() { is_open_ = opens_next_; }
  bool is_open() const { return is_open_; }
  /// Whether the frame was searched as it needs. If not, the gate is open now and the frame is to be searched again;
  /// the second answer is always true.
  bool suffices(const RelaxationTally& tally) {
    opens_next_ = limit_ < 1 && tally.undecided >= limit_ * tally.edges;
    const bool was_open = is_open_;
    is_open_ = is_open_ || opens_next_;
    return was_open == is_open_;
  }

 private:
  double limit_;
  bool is_open_ = false, opens_next_ = false;
};

}  // namespace quadedge::frontend
