/// \file edge_sample.cpp  Takes evenly spaced inliers per keyframe; a full sample is halved, and so is their number.
#include "cli/edge_sample.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "common/matching_constants.hpp"
#include "common/printed.hpp"
#include "geometry/corrected_rig.hpp"
#include "motion/latest_frame.hpp"
#include "motion/quads.hpp"

namespace quadedge::cli {
namespace {

constexpr std::size_t kMost = 16000;
constexpr double kMostDepthError = 0.03;  ///< relative, for an error of the disparity of kDisparityError
constexpr double kDisparityError = 0.2;   ///< [px]

/// An edge of the keyframe in the left camera's frame; nothing where its depth is too uncertain.
std::optional<Eigen::Vector3d> point_of(const StereoRig& rig, const StereoEdges& edges, std::size_t i) {
  const auto measured = pose::measure(rig, pose::observation_of(edges, i), kMinEpipolarAngle);
  if (!measured || measured->inverse_depth_per_pixel * kDisparityError > kMostDepthError * measured->inverse_depth)
    return std::nullopt;
  return measured->oriented_point().point;
}

}  // namespace

void EdgeSample::add(const StereoOdometry& odometry, const FrameResult& result) {
  const int frame_number = frames_++;
  if (!result.new_key_rig || !result.world_from_left || result.ambiguous_motion) return;
  const auto frame = odometry::LatestFrame::of(odometry);
  if (frame.step == nullptr || !frame.step->ok()) return;
  const StereoRig rig = corrected_rig(odometry.rig(), result.rig);
  const odometry::MotionStep& step = *frame.step;
  const auto& inlier = step.motion.inlier;
  const auto inliers = static_cast<std::size_t>(std::count(inlier.begin(), inlier.end(), 1));
  const std::size_t every = std::max<std::size_t>(1, inliers / per_frame_);
  std::size_t number = 0;
  for (std::size_t q = 0; q < inlier.size(); ++q) {
    if (inlier[q] == 0 || number++ % every != 0) continue;
    const auto edge = step.matches.current[static_cast<std::size_t>(step.quads.match[q])];
    const auto point = point_of(rig, frame.frame_edges->edges, static_cast<std::size_t>(edge));
    if (point) points_.push_back({frame_number, *result.world_from_left * *point});
  }
  if (points_.size() > kMost) thin();
}

/// Keeps every second point, and takes half as many from every keyframe that follows.
void EdgeSample::thin() {
  for (std::size_t i = 0; 2 * i < points_.size(); ++i) points_[i] = points_[2 * i];
  points_.resize((points_.size() + 1) / 2);
  per_frame_ = std::max<std::size_t>(1, per_frame_ / 2);
}

std::string EdgeSample::csv() const {
  std::string text = "frame,x_m,y_m,z_m\n";
  for (const Point& point : points_)
    text += printed("%d,%.3f,%.3f,%.3f\n", point.frame, point.position.x(), point.position.y(), point.position.z());
  return text;
}

}  // namespace quadedge::cli
