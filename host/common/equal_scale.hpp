#pragma once
/// \file equal_scale.hpp  Equalises cameras of different resolution.

#include "quadedge/camera.hpp"

namespace quadedge {

/// Edges and patches have a fixed scale in pixels. If the focal length in pixels of one camera is at least one and a
/// half times that of the other, their patches cover different parts of the scene. Such a camera is reduced to a half,
/// a third ... of its resolution; its undistortion table samples the recorded image at the pixel centres, which for a
/// half is the mean of four pixels. Other rigs are returned unchanged.
StereoRig with_equal_scales(StereoRig rig);

/// Reduces both cameras of such a rig in the same way if their focal length is at least one and a half times that of
/// another camera, with whose edges theirs are to be matched.
StereoRig with_scale_of(const PinholeCamera& camera, StereoRig rig);

}  // namespace quadedge
