/// \file opencv_baseline.cpp  Matches SIFT by Lowe's ratio, triangulates, and solves PnP with RANSAC between frames.
#include "opencv_baseline.hpp"

#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

#include "geometry/undistortion.hpp"

namespace quadedge::bench {
namespace {

constexpr float kRatio = 0.8F;             ///< Lowe's ratio: best descriptor distance over the second best
constexpr double kEpipolarDistance = 1.0;  ///< of a right key point from its epipolar line [px]
constexpr double kReprojection = 1.0;      ///< of a PnP inlier [px]
constexpr int kIterations = 1000;          ///< limit for RANSAC
constexpr double kConfidence = 0.999;
constexpr int kMinInliers = 12;  ///< as in pose.min_inliers

/// Best matches that are clearly better than the second best. Returns none for a cv::Mat without rows.
std::vector<cv::DMatch> match(const cv::Mat& from, const cv::Mat& to) {
  std::vector<cv::DMatch> kept;
  if (from.rows == 0 || to.rows < 2) return kept;
  std::vector<std::vector<cv::DMatch>> nearest;
  cv::BFMatcher(cv::NORM_L2).knnMatch(from, to, nearest, 2);
  for (const auto& two : nearest) {
    if (two.size() == 2 && two[0].distance < kRatio * two[1].distance) kept.push_back(two[0]);
  }
  return kept;
}

/// 3 x 4 projection K [R | t].
cv::Mat projection(const PinholeCamera& camera, const Eigen::Isometry3d& camera_from_left) {
  const Eigen::Matrix<double, 3, 4> matrix = camera.matrix() * camera_from_left.matrix().topRows<3>();
  cv::Mat result;
  cv::eigen2cv(matrix, result);
  return result;
}

/// F with right^T F left = 0 for pixels of the two cameras.
Eigen::Matrix3d fundamental_matrix(const StereoRig& rig) {
  const Eigen::Vector3d t = rig.right_from_left.translation();
  Eigen::Matrix3d cross;
  cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  return rig.right.matrix().inverse().transpose() * cross * rig.right_from_left.linear() * rig.left.matrix().inverse();
}

}  // namespace

OpencvBaseline::OpencvBaseline(const StereoRig& rig)
    : rig_(rig),
      fundamental_(fundamental_matrix(rig)),
      left_projection_(projection(rig.left, Eigen::Isometry3d::Identity())),
      right_projection_(projection(rig.right, rig.right_from_left)) {
  check_rig(rig, "stereo rig");
  cv::eigen2cv(rig.left.matrix(), left_matrix_);
}

Features OpencvBaseline::detect(const ImageView& recorded, const UndistortionTable& table) const {
  Image pinhole = to_8_bits(table.empty() ? recorded : undistort(recorded, table).view());
  const cv::Mat image(pinhole.height, pinhole.width, CV_8UC1, pinhole.pixels.data());
  Features features;
  sift_->detectAndCompute(image, cv::noArray(), features.points, features.descriptors);
  return features;
}

OpencvBaseline::StereoPoints OpencvBaseline::triangulate(const Features& left, const Features& right) const {
  StereoPoints result;
  std::vector<cv::Point2d> left_pixels, right_pixels;
  std::vector<int> rows;
  for (const auto& pair : match(left.descriptors, right.descriptors)) {
    const cv::Point2f a = left.points[static_cast<std::size_t>(pair.queryIdx)].pt,
                      b = right.points[static_cast<std::size_t>(pair.trainIdx)].pt;
    const Eigen::Vector3d line = fundamental_ * Eigen::Vector3d(a.x, a.y, 1);
    if (std::abs(line.dot(Eigen::Vector3d(b.x, b.y, 1))) > kEpipolarDistance * line.head<2>().norm()) continue;
    left_pixels.push_back(a);
    right_pixels.push_back(b);
    rows.push_back(pair.queryIdx);
  }
  if (rows.empty()) return result;
  cv::Mat homogeneous;
  cv::triangulatePoints(left_projection_, right_projection_, left_pixels, right_pixels, homogeneous);
  homogeneous.convertTo(homogeneous, CV_64F);
  for (int i = 0; i < homogeneous.cols; ++i) {
    const cv::Vec4d h(homogeneous.at<double>(0, i), homogeneous.at<double>(1, i), homogeneous.at<double>(2, i),
                      homogeneous.at<double>(3, i));
    const Eigen::Vector3d point(h[0] / h[3], h[1] / h[3], h[2] / h[3]);
    if (!point.allFinite() || point.z() <= 0 || (rig_.right_from_left * point).z() <= 0) continue;
    result.points.emplace_back(point.x(), point.y(), point.z());
    result.descriptors.push_back(left.descriptors.row(rows[static_cast<std::size_t>(i)]));
  }
  return result;
}

bool OpencvBaseline::find_motion(const Features& left, BaselineResult& result, Eigen::Isometry3d& motion) const {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (const auto& pair : match(previous_.descriptors, left.descriptors)) {
    points.push_back(previous_.points[static_cast<std::size_t>(pair.queryIdx)]);
    pixels.emplace_back(left.points[static_cast<std::size_t>(pair.trainIdx)].pt);
  }
  result.matches = static_cast<int>(points.size());
  if (result.matches < kMinInliers) return false;
  cv::Mat turn, shift;
  std::vector<int> inliers;
  if (!cv::solvePnPRansac(points, pixels, left_matrix_, cv::noArray(), turn, shift, false, kIterations, kReprojection,
                          kConfidence, inliers))
    return false;
  result.inliers = static_cast<int>(inliers.size());
  if (result.inliers < kMinInliers) return false;
  std::vector<cv::Point3d> inlier_points;
  std::vector<cv::Point2d> inlier_pixels;
  for (const int i : inliers) {
    inlier_points.push_back(points[static_cast<std::size_t>(i)]);
    inlier_pixels.push_back(pixels[static_cast<std::size_t>(i)]);
  }
  cv::solvePnPRefineLM(inlier_points, inlier_pixels, left_matrix_, cv::noArray(), turn, shift);
  cv::Mat rotation;
  cv::Rodrigues(turn, rotation);
  Eigen::Matrix3d linear;
  Eigen::Vector3d translation;
  cv::cv2eigen(rotation, linear);
  cv::cv2eigen(shift, translation);
  motion.linear() = Eigen::Quaterniond(linear).normalized().toRotationMatrix();
  motion.translation() = translation;
  return motion.matrix().allFinite();
}

BaselineResult OpencvBaseline::track(const StereoFrame& frame) {
  BaselineResult result;
  const Features left = detect(frame.left, rig_.left_undistortion),
                 right = detect(frame.right, rig_.right_undistortion);
  Eigen::Isometry3d motion = last_motion_;
  result.tracked = !has_previous_ || find_motion(left, result, motion);
  if (has_previous_) {
    world_from_last_ = world_from_last_ * motion.inverse();
    if (result.tracked) last_motion_ = motion;
  }
  has_previous_ = true;
  previous_ = triangulate(left, right);
  result.stereo_points = static_cast<int>(previous_.points.size());
  result.world_from_left = world_from_last_;
  return result;
}

}  // namespace quadedge::bench
