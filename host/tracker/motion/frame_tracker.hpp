#pragma once
/// \file frame_tracker.hpp  The way of a frame from two images to a pose (doc/design.md section 1).

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "motion/earlier_rigs.hpp"
#include "motion/frame_preparation.hpp"
#include "motion/latest_frame.hpp"
#include "motion/learned_rig.hpp"
#include "motion/motion_search.hpp"
#include "motion/shared_lens.hpp"
#include "motion/tracking_state.hpp"
#include "quadedge/odometry.hpp"

namespace quadedge::odometry {

/// Tracks frame by frame, and keeps what later frames are measured against. For one thread at a time.
class FrameTracker {
 public:
  /// For a rig and a configuration that are checked; the device must outlive the object.
  FrameTracker(const StereoRig& rig, Device& device, const Config& config);

  // As those of StereoOdometry.
  FrameResult track(const StereoFrame& frame);
  void restart();
  FrameDetails details() const;
  const StereoEdges& stereo_edges() const {
    static const StereoEdges none;
    return current_ ? current_->edges : none;
  }
  const StereoRig& rig() const { return rig_; }
  const Config& config() const { return config_; }

  LatestFrame latest_frame() const;
  frontend::Frontend& frontend() const { return preparation_.frontend(); }

 private:
  void process(const StereoFrame& frame, FrameResult& result);
  void hide(const PixelMask& left);
  void start(FrameResult& result);
  StepHandle search();
  StepHandle search_earlier(MotionQuery query);
  void adopt(StepHandle found, FrameResult& result);
  void return_to_earlier(FrameResult& result);
  void start_segment(FrameResult& result);
  Eigen::Matrix<double, 6, 1> offset_sensitivity(const MotionStep& step) const;
  void locate(const MotionStep& step, FrameResult& result);
  void adopt_rig(const MotionStep& step);
  void judge_lenses(const MotionStep& step);
  void report(const MotionStep& step, FrameResult& result);
  void set_key(frontend::FrameEdgesHandle frame_edges, const pose::UncertainPose& pose, double inverse_depth,
               bool keeps);
  void lose(FrameStatus status, const std::string& message, FrameResult& result);

  StereoRig rig_;  ///< the cameras in which edges are detected
  Device& device_;
  Config config_;
  FramePreparation preparation_;
  rig::LearnedRig learned_;
  /// None once it has warned, or once images are displaced, which looks alike.
  std::optional<rig::SharedLens> lenses_{std::in_place};
  std::unique_ptr<MotionFinder> motion_search_;

  TrackingState state_;
  EarlierRigs earlier_;
  bool keeps_key_ = true;     ///< for a loss, when it is replaced: the motion that gave it its pose is not ambiguous
  double inverse_depth_ = 0;  ///< mean of what the frame located last sees [1/m]
  ConstantVelocity velocity_;
  bool has_returned_ = false;                           ///< the last frame was located against an earlier keyframe
  bool was_lost_ = false;                               ///< the last frame
  std::optional<Eigen::Isometry3d> current_from_last_;  ///< of a frame just located, if the last one was, too
  frontend::FrameEdgesHandle current_;                  ///< of the last frame tracked; null before the first frame
  StepHandle step_;                                     ///< its motion; null if none was searched for
  std::optional<std::int64_t> last_stamp_ns_;
  TimeStep since_last_;
  bool starts_segment_ = false;    ///< with the next frame that has edges
  bool at_start_ = false;          ///< no motion has been searched for since the first frame
  std::vector<double> distances_;  ///< buffer of median_parallax()
};

}  // namespace quadedge::odometry
