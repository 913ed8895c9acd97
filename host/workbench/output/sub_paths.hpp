#pragma once
/// \file sub_paths.hpp  Relative errors over sub-paths of given lengths, as KITTI's odometry devkit defines them.

#include <Eigen/Geometry>
#include <vector>

#include "quadedge/evaluation.hpp"

namespace quadedge::evaluation {

/// A pose and its ground truth.
struct MatchedPoses {
  std::int64_t stamp_ns;
  Eigen::Isometry3d estimate, truth;
  int segment;
};

/// Of all errors that have a value; NaN if none has.
ErrorStatistics statistics(std::vector<double> errors);

/// One entry per length [m], with `count` 0 and errors NaN where the path is too short.
std::vector<SubPathErrors> sub_path_errors(const std::vector<MatchedPoses>& poses, const std::vector<double>& lengths);

/// The mean over the sub-paths of all lengths.
SubPathErrors mean_of(const std::vector<SubPathErrors>& lengths);

/// Angle of a rotation [deg], accurate near 0 and 180 degrees, unlike the arc cosine of the trace.
double angle_deg(const Eigen::Matrix3d& rotation);

}  // namespace quadedge::evaluation
