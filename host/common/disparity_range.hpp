#pragma once
/// \file disparity_range.hpp  The disparity range of a rig if the configuration does not state one.

#include <string>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge {

/// The configuration with a disparity range: if it has neither stereo.max_disparity nor stereo.min_depth,
/// stereo.max_disparity becomes rig.disparity_range(). \throws DataError as check_disparity_range().
Config with_disparity_range(Config config, const StereoRig& rig);

/// \throws DataError that names `source` (the calibration file) if focal length and baseline are so large that
/// rig.disparity_range() exceeds the largest value of stereo.max_disparity.
void check_disparity_range(const StereoRig& rig, const std::string& source);

}  // namespace quadedge
