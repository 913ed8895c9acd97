#pragma once
/// \file pose_covariance.hpp  How uncertain a pose is, in the form that ROS's PoseWithCovariance has.

#include <Eigen/Core>

namespace quadedge {

/// Covariance of the pose of a camera in a fixed frame: (x, y, z [m], rotation about x, y, z [rad]), all along and
/// about the axes of the FIXED frame. The errors are position_estimate - position_true and the rotation vector of
/// R_estimate R_true^T, where R turns the camera's axes into those of the fixed frame.
using PoseCovariance = Eigen::Matrix<double, 6, 6>;

}  // namespace quadedge
