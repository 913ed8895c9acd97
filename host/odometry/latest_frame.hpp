#pragma once
/// \file latest_frame.hpp  What a map needs of the frame tracked last.

#include "frontend/frontend.hpp"
#include "odometry/disparity_offset.hpp"

namespace quadedge::odometry {

/// Refers to parts of a StereoOdometry, which must outlive it.
struct LatestFrame {
  frontend::Frontend& frontend;
  frontend::FrameEdgesHandle rig;  ///< null before the first frame
  const DisparityOffset& offset;
};

}  // namespace quadedge::odometry
