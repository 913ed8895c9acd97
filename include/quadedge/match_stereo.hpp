#pragma once
/// \file match_stereo.hpp  Stereo edges of a single pair.

#include <optional>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/device.hpp"
#include "quadedge/edge_map.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"

namespace quadedge {

/// What one pair shows.
struct StereoMatches {
  EdgeSet left_edges;  ///< those that were searched for
  StereoEdges edges;
  /// One per stereo edge, in the left camera's frame; nothing where its disparity is none of a point in front of both
  /// cameras.
  std::vector<std::optional<MapPoint>> points;
  StereoRig rig;  ///< in whose pixels edges are told; see StereoOdometry::rig()
};

/// Matches the edges of a pair on the chosen device. \throws DataError for an unusable rig and for images that do not
/// fit it, UsageError for a bad configuration, DeviceError.
StereoMatches match_stereo(const StereoFrame& frame, const StereoRig& rig, Device& device, const Config& config);

/// A rig for images that are rectified already and whose cameras are unknown: rows belong together, and depths mean
/// nothing. Sizes in pixels.
StereoRig rectified_images(int width, int height, int right_width, int right_height);

}  // namespace quadedge
