#pragma once
/// \file frame_preparation.hpp  What a frame goes through before its motion is searched for: the stereo edges, and
/// whether the images fit the rig.

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/images.hpp"
#include "edges/frontend.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/device.hpp"
#include "quadedge/error.hpp"
#include "quadedge/odometry.hpp"
#include "rig/rectification_follower.hpp"
#include "rig/rig_monitor.hpp"

namespace quadedge::odometry {

/// Throws if the rig or the configuration cannot be used. \throws DataError, UsageError
void check_usable(const StereoRig& rig, const Config& config);

/// Why a frame cannot be located.
struct FrameFault {
  FrameStatus status = FrameStatus::lost_too_few_edges;  ///< or lost_rig_mismatch
  std::string text;
};

/// The front end of a rig, the check of its calibration and the warnings about its recording.
class FramePreparation {
 public:
  /// \param recorded the cameras of the images \param rig those in which edges are detected; must outlive the object
  FramePreparation(const StereoRig& recorded, const StereoRig& rig, Device& device, const Config& config);

  /// \throws DataError for images that do not fit the rig
  void check(const StereoFrame& frame) const { recorded_.check(frame); }
  /// Turns the images into the front end's current frame edges. \param rig as known of earlier frames; its rows are
  /// those that the front end corrects
  frontend::FrameEdgesHandle process(const StereoFrame& frame, RigEstimate rig);
  bool has_enough_edges() const { return static_cast<int>(current_->edges.size()) >= min_edges_; }
  /// Compares the images with the calibration; may run beside the search for matches.
  rig::RigReport judge(const StereoFrame& frame);
  /// Warns of the findings. \returns the reason why the frame cannot be located, if there is one
  std::optional<FrameFault> fault(const rig::RigReport& report);
  /// Takes over what a frame that was located shows of the rows, and of the cameras' synchronisation if the rows are
  /// those of the frames before. \param current_from_last left cameras [m], if that frame was located, too
  void adopt(const rig::RigReport& report, const std::optional<Eigen::Isometry3d>& current_from_last);
  /// Hides pixels of the left image, besides those that the rig masks, from the next frame on.
  void hide(const PixelMask& mask) { frontend_->hide(mask); }

  /// Forgets the frames so far, what they hid, and their warnings; not what the rows are.
  void restart();

  void warn(const Warning& warning) { warnings_.push_back(warning); }
  /// Warnings since the last call, of kinds that no earlier call has returned.
  std::vector<Warning> new_warnings();

  frontend::Frontend& frontend() const { return *frontend_; }

 private:
  RecordedImages recorded_;
  int min_edges_;
  bool checks_rig_;  ///< whether images are compared with the calibration; not in the method of the paper
  std::vector<Warning> warnings_;
  std::set<WarningKind> reported_;
  std::unique_ptr<rig::RectificationFollower> rows_;
  std::unique_ptr<frontend::Frontend> frontend_;
  std::function<std::unique_ptr<rig::RigMonitor>()> new_monitor_;
  std::unique_ptr<rig::RigMonitor> rig_monitor_;
  frontend::FrameEdgesHandle current_;
};

}  // namespace quadedge::odometry
