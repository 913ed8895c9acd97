#pragma once
/// \file latest_frame.hpp  The frame tracked last, as maps and the commands see it.

#include "edges/frontend.hpp"
#include "motion/motion_step.hpp"
#include "quadedge/odometry.hpp"

namespace quadedge::odometry {

/// Refers to parts of a StereoOdometry, which must outlive it.
struct LatestFrame {
  Device& device;
  frontend::Frontend& frontend;
  frontend::FrameEdgesHandle frame_edges;  ///< null before the first frame
  RigEstimate rig;                         ///< of the next frame, as far as it is known
  const MotionStep* step;                  ///< its motion; null if none was searched for

  static LatestFrame of(const StereoOdometry& odometry);
};

}  // namespace quadedge::odometry
