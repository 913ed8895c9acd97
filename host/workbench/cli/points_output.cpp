/// \file points_output.cpp  Feeds keyframes to the point cloud and frames to the map; adds its time to the latency.
#include "cli/points_output.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "common/matching_constants.hpp"
#include "common/printed.hpp"
#include "common/timing.hpp"
#include "data/atomic_file.hpp"
#include "geometry/corrected_rig.hpp"
#include "motion/latest_frame.hpp"
#include "motion/quads.hpp"
#include "output/output_folder.hpp"
#include "output/result_rows.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
void PointFiles::declare(Options& options) {
  options.group("Points in space");
  options.output("--points", ply, "write the 3D edges of all keyframes as a binary PLY file");
  options.number("--points-min-views", min_views, "minimum number of keyframes that see a point");
}

void PointFiles::check(bool force) const {
  if (min_views < 1) throw UsageError("--points-min-views " + std::to_string(min_views) + ": expected 1 or more");
  report::check_output_file(ply, force);
}

PointsOutput::PointsOutput(const PointFiles& files, const Config& config) : files_(files) {
  if (files.ply.empty()) return;
  PointCloudOptions options;
  options.min_views = files.min_views;
  cloud_ = std::make_unique<PointCloud>(config, options);
}

void PointsOutput::add(const FramePrefetcher::Frame& frame, const FrameResult& result, const StereoOdometry& odometry) {
  if (cloud_) cloud_->add(frame.view(), result, odometry);
}

void PointsOutput::correct(const Map& map) {
  if (cloud_) cloud_->correct([&](int frame) { return map.pose(frame); });
}

void PointsOutput::write() {
  if (!cloud_ || cloud_->views().empty()) return;
  const auto points = cloud_->points();
  write_ply(files_.ply, points);
  facts_ = report::PointFacts{points.size(), cloud_->views().size(), cloud_->dropped()};
}

void LoopOutput::add(const FrameResult& result) {
  const auto start = Clock::now();
  map_.add(result);
  const double ms = milliseconds_since(start);
  total_ms_ += ms;
  latencies_ms_.push_back(result.timing.latency_ms + ms);
}

const Map& LoopOutput::finish(bool after_error) {
  const auto start = Clock::now();
  try {
    map_.finish();
  } catch (const DeviceError&) {
    if (!after_error) throw;
  }
  total_ms_ += milliseconds_since(start);
  return map_;
}

report::LoopFacts LoopOutput::write(const std::string& folder, const std::string& saved_map) const {
  const Trajectory trajectory = map_.trajectory();
  write_tum(folder + "/trajectory_map.txt", trajectory);
  data::write_atomically(folder + "/loops.csv", report::loops_csv(map_.closures()));
  if (!saved_map.empty()) write_map(saved_map, map_.saved());
  report::LoopFacts facts;
  facts.compared = map_.closures().size();
  facts.kept = static_cast<std::size_t>(
      std::count_if(map_.closures().begin(), map_.closures().end(),
                    [](const Closure& closure) { return closure.verdict == ClosureVerdict::kept; }));
  facts.segments = map_.segments();
  facts.frames = trajectory.size();
  facts.key_rigs = map_.key_rigs();
  facts.megabytes = static_cast<double>(map_.bytes()) / 1e6;
  facts.total_ms = total_ms_;
  facts.latency = report::latency_summary(latencies_ms_);
  return facts;
}

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
