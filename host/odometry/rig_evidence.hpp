#pragma once
/// \file rig_evidence.hpp  Whether a frame's images belong to the calibration (doc/method.md section 7).

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "odometry/epipolar_probe.hpp"
#include "odometry/rig_findings.hpp"
#include "odometry/synchronisation.hpp"
#include "quadedge/config.hpp"
#include "quadedge/rig_evidence.hpp"

namespace quadedge::odometry {

/// Watches over the calibration from frame to frame. A frame costs some hundred aligned patches; the search around the
/// epipolar lines, some ten times as much, is done where there is a reason: in the first frame with edges, where fewer
/// edges are matched or lie farther off than before, while the calibration does not fit, and every so often.
class RigWatch {
 public:
  RigWatch(const StereoRig& rig, const Config& config);

  /// Judges the next frame. \param edges its stereo edges \param left_edges number of edges in its left image
  /// \param evidence what was measured
  RigFindings judge(const StereoFrame& frame, const StereoEdges& edges, int left_edges, RigEvidence& evidence);

  /// Takes in how the edges of that frame moved in the image; says whether one camera seems to be late.
  /// \param base_frame number of the frame of `base`, which `matches` pairs with it \param frame its own number
  std::string observe_motion(const StereoEdges& base, int base_frame, const StereoEdges& now, int frame,
                             const TemporalMatches& matches);

 private:
  /// Names the image that is the same as in the frame before while the other one is not; empty where there is none.
  std::string find_frozen(const StereoFrame& frame);
  bool has_reason_to_search(const RigEvidence& evidence) const;

  StereoRig rig_;
  EpipolarProbe probe_;
  Synchronisation synchronisation_;
  std::vector<CornerMatch> spots_;  ///< of the last frame judged
  std::vector<int> sampled_;        ///< the spot of every stereo edge, or -1; kept for its memory
  // Where the edges of a base were in the frame before:
  int base_frame_ = -1, last_frame_ = -1;
  std::vector<float> last_x_, last_y_, next_x_, next_y_;
  std::optional<RigEvidence> searched_;  ///< of the last frame with a search
  bool fits_ = true;                     ///< as that search said
  int frames_since_search_ = 0;
  std::optional<std::uint64_t> last_left_, last_right_;  ///< fingerprints of the images before
};

/// The same of one frame by itself, without edges: what `quadedge check` asks.
RigFindings examine_frame(const StereoRig& rig, const StereoFrame& frame, double max_disparity, RigEvidence& evidence);

}  // namespace quadedge::odometry
