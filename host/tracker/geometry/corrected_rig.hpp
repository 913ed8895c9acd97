#pragma once
/// \file corrected_rig.hpp  The geometry of a frame: the calibration, corrected by what is known of the rig.

#include "quadedge/camera.hpp"
#include "quadedge/rig_estimate.hpp"

namespace quadedge {

/// Unit vector along which a point in the middle of the right image moves when its depth decreases.
Eigen::Vector2d direction_of_nearer(const StereoRig& rig);

/// The rig with its right principal point moved so that disparities are those of the calibration. The result has no
/// undistortion tables and no masks. Rows are none of it, since right points lie on the lines of the calibration.
StereoRig corrected_rig(const StereoRig& rig, const RigEstimate& estimate);

}  // namespace quadedge
