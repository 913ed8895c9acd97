#pragma once
/// \file edge_points.hpp  Stereo edges as points with tangents in space.

#include <Eigen/Core>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"

namespace quadedge {

/// One column per stereo edge, in the left camera frame at the time of the edges. NaN for edges without depth: those
/// parallel to their epipolar line (stereo.min_epipolar_angle) or behind a camera.
struct EdgePoints {
  Eigen::Matrix3Xd position;  ///< metres
  Eigen::Matrix3Xd tangent;   ///< unit length; its projection has the direction of the left edge, including the sign
};

/// Triangulates stereo edges (doc/method.md section 5). `rig`: the cameras in which the edges were found,
/// StereoOdometry::rig(). `disparity_offset`: estimated rectification error, FrameResult::disparity_offset [px].
EdgePoints edge_points(const StereoEdges& edges, const StereoRig& rig, const Config& config,
                       double disparity_offset = 0);

}  // namespace quadedge
