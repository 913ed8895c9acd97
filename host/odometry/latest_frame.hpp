#pragma once
/// \file latest_frame.hpp  The frame tracked last, as a map of the same library sees it.

#include "frontend/frontend.hpp"
#include "odometry/disparity_offset.hpp"
#include "quadedge/odometry.hpp"

namespace quadedge::odometry {

/// Refers to parts of a StereoOdometry, which must outlive it.
struct LatestFrame {
  frontend::Frontend& frontend;
  frontend::FrameEdgesHandle frame_edges;  ///< null before the first frame
  const DisparityOffset& offset;

  static LatestFrame of(const StereoOdometry& odometry);
};

}  // namespace quadedge::odometry
