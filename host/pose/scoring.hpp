#pragma once
/// \file scoring.hpp  How well quads agree with a motion: truncated quadratic reprojection error in both images of the
/// current rig.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "pose/quads.hpp"
#include "quadedge/camera.hpp"

namespace quadedge::pose {

/// K [R | T] of the later rig's cameras in single precision, row-major 3 x 4: homogeneous pixels from (ray, inverse
/// depth).
struct LaterCameras {
  LaterCameras(const StereoRig& rig, const Eigen::Isometry3d& current_from_previous);
  float left[12], right[12];
};

/// Mean over the rows of min(d^2, threshold^2) / threshold^2, where d is the larger of the distances (px) in the two
/// images between the projected previous point and the current position; 1 for a point that is not in front of both
/// cameras. 0 is perfect, 1 worthless. An empty set costs 1. Rows are summed in a fixed order.
double truncated_cost(const ScoringArrays& quads, const LaterCameras& cameras, double threshold);

/// Rows within `threshold` px in both images, in front of both cameras, whose projected tangent agrees with the
/// measured direction within `max_angle` radians in both images, modulo 180 degrees. \param inlier one byte per row,
/// resized. \returns how many.
int select_inliers(const ScoringArrays& quads, const LaterCameras& cameras, double threshold, double max_angle,
                   std::vector<std::uint8_t>& inlier);

/// Square cells of side `cell` px of the current left image that hold a row with a non-zero byte in `mask`.
int count_cells(const ScoringArrays& quads, const std::vector<std::uint8_t>& mask, double cell);

}  // namespace quadedge::pose
