#pragma once
/// \file match_stereo.hpp  Stereo edges of a single pair, and stereo edges as points with tangents in space.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "quadedge/detect_edges.hpp"
#include "quadedge/error.hpp"
#include "quadedge/point_cloud.hpp"

namespace quadedge {

/// One column per stereo edge, in the left camera frame at the time of the edges. NaN for edges without depth: those
/// parallel to their epipolar line (within 4 degrees) or behind a camera.
struct EdgePoints {
  Eigen::Matrix3Xd position;  ///< metres
  Eigen::Matrix3Xd tangent;   ///< unit length; its projection has the direction of the left edge, including the sign
};

/// Triangulates stereo edges (doc/method.md section 5). `rig`: the cameras in which the edges were found,
/// StereoOdometry::rig(). `estimate`: what is known of the rig, FrameResult::rig.
EdgePoints edge_points(const StereoEdges& edges, const StereoRig& rig, const RigEstimate& estimate = {});

/// Result of match_stereo().
struct StereoMatches {
  EdgeSet left_edges;  ///< edges of the left image that were matched
  StereoEdges edges;
  /// One per stereo edge, in the left camera frame; nothing if the disparity does not correspond to a point in front of
  /// both cameras.
  std::vector<std::optional<CloudPoint>> points;
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
