#pragma once
/// \file match_stereo.hpp  Stereo edges of a single image pair.

#include <optional>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/device.hpp"
#include "quadedge/edge_map.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"
#include "quadedge/warning.hpp"

namespace quadedge {

/// Result of match_stereo().
struct StereoMatches {
  EdgeSet left_edges;  ///< edges of the left image that were matched
  StereoEdges edges;
  /// One per stereo edge, in the left camera frame; nothing if the disparity does not correspond to a point in front of
  /// both cameras.
  std::vector<std::optional<MapPoint>> points;
  StereoRig rig;  ///< the cameras that edge positions refer to; see StereoOdometry::rig()
  std::vector<Warning> warnings;
};

/// Matches the edges of an image pair on `device`. Without a disparity range in the configuration, the range is
/// StereoRig::disparity_range(), or larger if the images need that. \throws DataError for an unusable rig and for
/// images that do not fit it; UsageError for an invalid configuration; DeviceError.
StereoMatches match_stereo(const StereoFrame& frame, const StereoRig& rig, Device& device, const Config& config = {});

/// A rig for rectified images of unknown cameras: rows correspond, and depths are meaningless. Sizes in pixels. Its
/// max_disparity is 0.12 times the width.
StereoRig rectified_images(int width, int height, int right_width, int right_height);

}  // namespace quadedge
