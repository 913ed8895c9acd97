#pragma once
/// \file poses_csv.hpp  poses.csv: pose and covariance of every input frame.

#include <Eigen/Geometry>
#include <array>
#include <cstddef>

#include "report/frame_rows.hpp"

namespace quadedge::report {

/// Names of the columns of a pose: x, y, z [m] and the quaternion qx, qy, qz, qw.
constexpr std::array<const char*, 7> kPoseColumns = {"x", "y", "z", "qx", "qy", "qz", "qw"};
/// Value of column `i` of kPoseColumns.
double pose_value(const Eigen::Isometry3d& pose, std::size_t i);

/// The columns of poses.csv: frame, stamp_s, status, segment, reference_frame; the left camera's pose in the world (x,
/// y, z [m], qx, qy, qz, qw) and in the frame of the reference's left camera (reference_x ... reference_qw); then the
/// upper triangles of both covariances, row by row (covariance_x_x, covariance_x_y ... covariance_rz_rz and
/// reference_covariance_...), in the order x, y, z, rotation about x, y, z of the frame that the pose is in; see
/// PoseCovariance. Fields without a value are empty: a lost frame has the predicted pose in the world and nothing else.
const FrameColumns& poses_csv_columns();

/// \throws DataError for a missing or damaged file.
CsvTable read_poses_csv(const std::string& file);

}  // namespace quadedge::report
