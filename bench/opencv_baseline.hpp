#pragma once
/// \file opencv_baseline.hpp  A simple visual odometry with OpenCV: SIFT, stereo matching, PnP with RANSAC, from frame
/// to frame. Its accuracy is compared with QuadEdge's; it is not part of the product.

#include <Eigen/Geometry>
#include <opencv2/features2d.hpp>
#include <vector>

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

/// Key points of one image with their descriptors, one per row.
struct Features {
  std::vector<cv::KeyPoint> points;
  cv::Mat descriptors;
};

/// Stereo visual odometry from frame to frame: SIFT key points of both images, brute-force matching with Lowe's ratio
/// test both between left and right (kept near the epipolar line and in front of both cameras, then triangulated) and
/// between the frames before and now (left images), cv::solvePnPRansac, and cv::solvePnPRefineLM over its inliers.
/// Uses OpenCV's defaults except for the constants in the source. Deterministic.
class OpencvBaseline {
 public:
  /// \throws DataError for an unusable rig.
  explicit OpencvBaseline(const StereoRig& rig);
  /// Processes the next frame. Takes recorded images, which are undistorted here if the rig has tables.
  BaselineResult track(const StereoFrame& frame);

 private:
  /// The left features with depth, in the left camera's frame.
  struct StereoPoints {
    std::vector<cv::Point3d> points;
    cv::Mat descriptors;
  };

  Features detect(const ImageView& recorded, const UndistortionTable& table) const;
  StereoPoints triangulate(const Features& left, const Features& right) const;
  /// current_from_previous; false if PnP finds too few inliers.
  bool find_motion(const Features& left, BaselineResult& result, Eigen::Isometry3d& motion) const;

  StereoRig rig_;
  Eigen::Matrix3d fundamental_;
  cv::Mat left_projection_, right_projection_, left_matrix_;
  cv::Ptr<cv::SIFT> sift_ = cv::SIFT::create();
  StereoPoints previous_;
  bool has_previous_ = false;
  Eigen::Isometry3d world_from_last_ = Eigen::Isometry3d::Identity(), last_motion_ = Eigen::Isometry3d::Identity();
};

}  // namespace quadedge::bench
