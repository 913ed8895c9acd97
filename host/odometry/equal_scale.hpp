#pragma once
/// \file equal_scale.hpp  Cameras of different resolution.

#include "quadedge/camera.hpp"

namespace quadedge::odometry {

/// Edges are found, and patches cut, at one scale in pixels: where one camera has at least one and a half times the
/// other's focal length in pixels, their patches show different things. Such a camera is replaced by one of a half, a
/// third ... of its resolution, whose undistortion table samples the recorded image at the middle of its pixels: for a
/// half that is the mean of four. Other rigs come back as they are.
StereoRig with_equal_scales(StereoRig rig);

}  // namespace quadedge::odometry
