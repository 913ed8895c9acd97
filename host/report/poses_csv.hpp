#pragma once
/// \file poses_csv.hpp  poses.csv: pose and covariance of every input frame, written while the run goes on.

#include <string>

#include "quadedge/odometry.hpp"
#include "report/append_file.hpp"

namespace quadedge::report {

/// Columns: frame, stamp_s, status, reference_frame; the left camera's pose in the world (x, y, z [m], qx, qy, qz, qw)
/// and in the frame of the reference's left camera (reference_x ... reference_qw); then the upper triangles of both
/// covariances, row by row (covariance_x_x, covariance_x_y ... covariance_rz_rz and reference_covariance_...), in the
/// order x, y, z, rotation about x, y, z of the frame that the pose is in; see PoseCovariance. Empty where nothing is
/// known: a lost frame has the predicted pose in the world and nothing else.
class PosesCsv {
 public:
  /// \throws DataError when the file cannot be written.
  explicit PosesCsv(const std::string& path);
  /// Adds the row of the next frame.
  void add(const FrameResult& result);

 private:
  AppendFile file_;
  int frames_ = 0;
};

}  // namespace quadedge::report
