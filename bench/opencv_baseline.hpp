#pragma once
/// \file opencv_baseline.hpp  A simple visual odometry with OpenCV: SIFT, stereo matching, PnP with RANSAC, from frame
/// to frame. Its accuracy is compared with QuadEdge's; it is not part of the product.

#include <Eigen/Geometry>
#include <memory>

#include "quadedge/camera.hpp"
#include "quadedge/odometry.hpp"

namespace quadedge::bench {

/// The result for one frame.
struct BaselineResult {
  bool tracked = false;  ///< true for the first frame
  /// Pose of the left camera in the frame of the first left camera. For a lost frame, the last motion is repeated.
  Eigen::Isometry3d world_from_left = Eigen::Isometry3d::Identity();
  int stereo_points = 0, matches = 0, inliers = 0;
};

/// Stereo visual odometry from frame to frame: SIFT key points of both images, brute-force matching with Lowe's ratio
/// test both between left and right (kept near the epipolar line and in front of both cameras, then triangulated) and
/// between the frames before and now (left images), cv::solvePnPRansac, and cv::solvePnPRefineLM over its inliers.
/// Uses OpenCV's defaults except for the constants in the source. Deterministic.
class OpencvBaseline {
 public:
  /// \throws DataError for an unusable rig.
  explicit OpencvBaseline(const StereoRig& rig);
  ~OpencvBaseline();

  /// Processes the next frame. Takes recorded images, which are undistorted here if the rig has tables.
  BaselineResult track(const StereoFrame& frame);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace quadedge::bench
