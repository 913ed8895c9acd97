#pragma once
/// \file edge_points.hpp  Stereo edges as points with tangents in space.

#include <Eigen/Core>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"

namespace quadedge {

/// A column per stereo edge, in the frame of the left camera at their time. NaN for an edge without a depth: one along
/// its epipolar line (stereo.min_epipolar_angle), or behind a camera.
struct EdgePoints {
  Eigen::Matrix3Xd position;  ///< metres
  Eigen::Matrix3Xd tangent;   ///< unit norm; its projection has the left edge's direction, sign included
};

/// Points of stereo edges (doc/method.md section 5). `rig`: the cameras that the edges were found with,
/// StereoOdometry::rig(). `disparity_offset`: FrameResult::disparity_offset, what the odometry has learned of the rig's
/// rectification [px].
EdgePoints edge_points(const StereoEdges& edges, const StereoRig& rig, const Config& config,
                       double disparity_offset = 0);

}  // namespace quadedge
