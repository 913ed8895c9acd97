#pragma once
/// \file scoring.hpp  Agreement of quads with a motion: truncated quadratic reprojection error in both images of the
/// current frame.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "motion/quads.hpp"
#include "quadedge/camera.hpp"

namespace quadedge::pose {

/// K [R | T] of the later rig's cameras in single precision, row-major 3 x 4: maps (ray, inverse depth) to homogeneous
/// pixels.
struct LaterCameras {
  LaterCameras(const StereoRig& rig, const Eigen::Isometry3d& current_from_previous);
  float left[12], right[12];
};

/// Mean over the rows of min(d^2, threshold^2) / threshold^2, where d [px] is the larger of the distances in the two
/// images between the projected previous point and the current position; 1 for a point that is not in front of both
/// cameras. 0 is perfect agreement, 1 none. An empty set costs 1. Rows are summed in a fixed order.
double truncated_cost(const ScoringArrays& quads, const LaterCameras& cameras, double threshold);

/// Selects the rows within `threshold` px in both images, in front of both cameras, whose projected tangent agrees with
/// the measured direction within `max_angle` [rad] in both images, modulo 180 degrees. \param inlier one byte per row,
/// resized
/// \returns their number
int select_inliers(const ScoringArrays& quads, const LaterCameras& cameras, double threshold, double max_angle,
                   std::vector<std::uint8_t>& inlier);

/// Number of square cells of side `cell` px in the current left image that contain a row with a non-zero byte in
/// `mask`.
int count_cells(const ScoringArrays& quads, const std::vector<std::uint8_t>& mask, double cell);

}  // namespace quadedge::pose
