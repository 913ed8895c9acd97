/// \file pair_collection.cpp  Tracks corners until they have moved far enough; searches right images at several depths.
#include "calibration/pair_collection.hpp"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>
#include <utility>

#include "common/numeric.hpp"
#include "geometry/calibration.hpp"
#include "geometry/lens_mapping.hpp"

namespace quadedge::rig {
namespace {

constexpr int kCorners = 700;
constexpr std::size_t kFewestTracks = 40;
/// Median way of the corners that ends a pair, as an angle from the optical axis [rad]: 15 px of 985.
constexpr double kEnoughFlow = 0.015;
constexpr int kLongestWait = 40;  ///< frames
constexpr double kMinAgreeing = 0.5;
/// Distance from the epipolar line that a calibration may leave [rad]: 12 px of 985.
constexpr double kAcross = 0.012;
constexpr double kCertainCorrelation = 0.92;

/// Where the right camera has what the left one has at `at`, at a depth.
std::optional<Eigen::Vector2d> in_right(const StereoCalibration& calibration, const Eigen::Vector3d& ray,
                                        double inverse_depth) {
  return LensMapping(calibration.right)
      .project(calibration.right_from_left.linear() * ray + inverse_depth * calibration.right_from_left.translation());
}

}  // namespace

PairCollector::PairCollector(const RigUnknowns& unknowns, double disparity,
                             std::function<bool(Side, const Eigen::Vector2d&)> hides)
    : unknowns_(unknowns), hides_(std::move(hides)) {
  for (double start = 4; start < std::max(5.0, disparity); start = start < 16 ? 16 : start * 2)
    disparities_.push_back(start);
}

void PairCollector::begin(FlowImage left, const FlowImage& right, int number) {
  std::vector<Eigen::Vector2d> corners = flow_corners(left, kCorners);
  corners.erase(
      std::remove_if(corners.begin(), corners.end(), [&](const auto& at) { return hides_ && hides_(Side::left, at); }),
      corners.end());
  std::vector<Track> tracks(corners.size());
  tbb::parallel_for(std::size_t{0}, corners.size(), [&](std::size_t i) {
    tracks[i] = {corners[i], corners[i], corners[i], find_right(left, right, corners[i])};
  });
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(), [](const Track& track) { return !track.right; }),
               tracks.end());
  if (tracks.size() < kFewestTracks) {
    first_.reset();
    return;
  }
  first_ = First{number, 0, std::move(left), std::move(tracks)};
}

std::optional<Eigen::Vector2d> PairCollector::find_right(const FlowImage& left, const FlowImage& right,
                                                         const Eigen::Vector2d& at) const {
  const StereoCalibration& given = unknowns_.given();
  const LensMapping lens(given.left);
  const auto ray = lens.ray(at);
  if (!ray) return std::nullopt;
  const auto far = in_right(given, *ray, 0);
  if (!far) return std::nullopt;
  const double focal = given.left.camera.fx, length = given.right_from_left.translation().norm();
  std::optional<FlowMatch> best;
  for (const double disparity : disparities_) {
    const auto start = in_right(given, *ray, disparity / (focal * length));
    if (!start) continue;
    const auto match = follow(left, right, at, *start);
    if (!match || (best && match->correlation <= best->correlation)) continue;
    if (hides_ && hides_(Side::right, match->at)) continue;
    // Beside the line by more than calibrations are off, or behind the camera, it is another corner.
    const Eigen::Vector2d line = (*start - *far).normalized(), from_far = match->at - *far;
    const double beside = std::abs(line.x() * from_far.y() - line.y() * from_far.x());
    if (beside > kAcross * focal || from_far.dot(line) < -kAcross * focal) continue;
    best = match;
    if (best->correlation > kCertainCorrelation) break;
  }
  return best ? std::optional(best->at) : std::nullopt;
}

/// Where a track is expected in the frame after the first one.
Eigen::Vector2d PairCollector::predicted(const Track& track) const {
  const StereoCalibration& given = unknowns_.given();
  const LensMapping left(given.left), right(given.right);
  const auto ray = left.ray(track.left), right_ray = right.ray(*track.right);
  if (!ray || !right_ray) return track.left;
  const Eigen::Vector3d by_depth = given.right_from_left.translation().cross(*right_ray);
  const double inverse_depth =
      -(given.right_from_left.linear() * *ray).cross(*right_ray).dot(by_depth) / by_depth.squaredNorm();
  const auto at = left.project(per_frame_.linear() * *ray + std::max(0.0, inverse_depth) * per_frame_.translation());
  return at.value_or(track.left);
}

void PairCollector::follow_tracks(const FlowImage& left) {
  std::vector<Track>& tracks = first_->tracks;
  const bool is_second = first_->age == 0;
  std::vector<std::optional<FlowMatch>> found(tracks.size());
  tbb::parallel_for(std::size_t{0}, tracks.size(), [&](std::size_t i) {
    const Track& track = tracks[i];
    const Eigen::Vector2d ahead = is_second ? predicted(track) : Eigen::Vector2d(2 * track.now - track.before);
    found[i] = follow(first_->left, left, track.left, ahead);
    if (found[i] && found[i]->correlation > kCertainCorrelation) return;
    const auto again = follow(first_->left, left, track.left, track.now);
    if (again && (!found[i] || again->correlation > found[i]->correlation)) found[i] = again;
  });
  std::vector<Track> kept;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (!found[i] || (hides_ && hides_(Side::left, found[i]->at))) continue;
    kept.push_back(tracks[i]);
    kept.back().before = tracks[i].now;
    kept.back().now = found[i]->at;
  }
  tracks = std::move(kept);
  ++first_->age;
}

double PairCollector::flow() const {
  std::vector<double> ways;
  for (const Track& track : first_->tracks) ways.push_back((track.now - track.left).norm());
  return ways.empty() ? 0 : upper_median(ways);
}

std::optional<FramePair> PairCollector::close(const FlowImage& left, const FlowImage& right, int number) {
  FramePair pair{first_->number, number, Eigen::Isometry3d::Identity(), {}};
  pair.points.resize(first_->tracks.size());
  tbb::parallel_for(std::size_t{0}, pair.points.size(), [&](std::size_t i) {
    const Track& track = first_->tracks[i];
    const auto match = follow(left, right, track.now, *track.right + (track.now - track.left));
    SeenPoint& point = pair.points[i];
    point.at = {track.left, *track.right, track.now, match ? match->at : Eigen::Vector2d::Zero()};
    point.is_seen = {true, true, true, match.has_value() && !(hides_ && hides_(Side::right, match->at))};
  });
  const int frames = std::max(1, number - pair.first);
  pair.second_from_first.linear() = rotation_by(frames * rounded_rotation(per_frame_));
  pair.second_from_first.translation() = frames * per_frame_.translation();
  if (PairAdjustment::find_motion(unknowns_, pair) < kMinAgreeing) {
    per_frame_.setIdentity();
    return std::nullopt;
  }
  per_frame_.linear() = rotation_by(rounded_rotation(pair.second_from_first) / frames);
  per_frame_.translation() = pair.second_from_first.translation() / frames;
  return pair;
}

std::optional<FramePair> PairCollector::see(const StereoFrame& frame, int number) {
  FlowImage left = pyramid(frame.left);
  if (first_) follow_tracks(left);
  const bool is_lost = !first_ || first_->tracks.size() < kFewestTracks || first_->age > kLongestWait;
  if (!is_lost && flow() < kEnoughFlow * unknowns_.given().left.camera.fx) return std::nullopt;
  const FlowImage right = pyramid(frame.right);
  std::optional<FramePair> pair;
  if (!is_lost) pair = close(left, right, number);
  begin(std::move(left), right, number);
  return pair;
}

}  // namespace quadedge::rig
