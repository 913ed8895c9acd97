#pragma once
/// \file disparity_range.hpp  The disparity range of a rig if the configuration does not state one.

#include <string>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge {

/// Whether the configuration states a range: stereo.max_disparity or stereo.min_depth. Otherwise the range follows the
/// images, see host/frontend/range_follower.hpp.
bool has_disparity_range(const StereoConfig& config);

/// The configuration with a disparity range: without one, stereo.max_disparity becomes rig.disparity_range().
/// \throws DataError as check_disparity_range().
Config with_disparity_range(Config config, const StereoRig& rig);

/// The largest range that the images of a rig are searched for without a range in the configuration [px]: half the
/// width of the left image, or StereoRig::max_disparity if that is larger.
double disparity_limit(const StereoRig& rig);

/// \throws DataError that names `source` (the calibration file) if focal length and baseline are so large that
/// rig.disparity_range() exceeds the largest value of stereo.max_disparity.
void check_disparity_range(const StereoRig& rig, const std::string& source);

}  // namespace quadedge
