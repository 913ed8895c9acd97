/// \file point_cloud.cpp  Merges the stereo edges of keyframes (doc/method.md section 9).
#include "quadedge/point_cloud.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "geometry/corrected_rig.hpp"
#include "geometry/oriented_point.hpp"
#include "places/measured_points.hpp"
#include "quadedge/camera.hpp"

namespace quadedge {
namespace {

/// Finds the edges near a position. The side of a cell is 2 px, the search radius around an edge.
class EdgeGrid {
 public:
  /// Sorts edges by cell, then by index. Positions in pixels.
  void fill(const std::vector<float>& x, const std::vector<float>& y, int width, int height) {
    columns_ = width / kCell + 1;
    rows_ = height / kCell + 1;
    first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
    for (std::size_t i = 0; i < x.size(); ++i) ++first_[cell(column(x[i]), row(y[i])) + 1];
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    edges_.resize(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) edges_[next[cell(column(x[i]), row(y[i]))]++] = i;
  }

  /// Calls visit(index) for every edge within 2 px along both axes, and for some farther away.
  template <class Visit>
  void for_each_near(double x, double y, const Visit& visit) const {
    for (int r = std::max(row(y) - 1, 0); r <= std::min(row(y) + 1, rows_ - 1); ++r) {
      for (int c = std::max(column(x) - 1, 0); c <= std::min(column(x) + 1, columns_ - 1); ++c) {
        for (std::size_t i = first_[cell(c, r)]; i < first_[cell(c, r) + 1]; ++i) visit(edges_[i]);
      }
    }
  }

 private:
  static constexpr int kCell = 2;  // px
  int column(double x) const { return std::clamp(static_cast<int>(x) / kCell, 0, columns_ - 1); }
  int row(double y) const { return std::clamp(static_cast<int>(y) / kCell, 0, rows_ - 1); }
  std::size_t cell(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  int columns_ = 0, rows_ = 0;
  std::vector<std::size_t> first_;  ///< edges of cell c: first_[c] .. first_[c + 1] - 1
  std::vector<std::size_t> edges_;
};

constexpr double kMaxDepthError = 0.1;  ///< relative; points with larger errors carry little more than their direction
constexpr double kAcross = 1.0;         ///< maximum distance of a projected point from an edge, across the edge [px]
constexpr double kAlong = 1.0;          ///< the same along the edge; edges are at least a pixel apart [px]
constexpr double kMaxSlide = 2;         ///< maximum displacement along the tangent, whose depth may be wrong [px]
constexpr double kTurn = 15 * kPi / 180;  ///< maximum angle between a projected tangent and an edge [rad]
constexpr double kDeviations = 3;         ///< maximum deviation of the disparity, in standard deviations
constexpr double kPoseNoise = 0.5;        ///< effect of pose errors between two keyframes on disparities [px]
constexpr int kMaxUnseenViews = 20;       ///< keyframes for which a point with few views may remain unobserved
constexpr std::int32_t kNone = -1;

/// 76 bytes per point; the information matrix is symmetric.
struct Point {
  Eigen::Vector3d position;
  std::array<float, 6> information;
  Eigen::Vector3f tangent;
  float grey;
  std::int32_t views;
  std::int32_t last_view;  ///< number of the last keyframe that observed it

  Eigen::Matrix3d information_matrix() const {
    const auto& i = information;
    Eigen::Matrix3d matrix;
    matrix << static_cast<double>(i[0]), static_cast<double>(i[1]), static_cast<double>(i[2]),
        static_cast<double>(i[1]), static_cast<double>(i[3]), static_cast<double>(i[4]), static_cast<double>(i[2]),
        static_cast<double>(i[4]), static_cast<double>(i[5]);
    return matrix;
  }
  void set_information(const Eigen::Matrix3d& matrix) {
    const auto entry = [&](int row, int column) { return static_cast<float>(matrix(row, column)); };
    information = {entry(0, 0), entry(0, 1), entry(0, 2), entry(1, 1), entry(1, 2), entry(2, 2)};
  }
};

/// A point that may be merged with an edge of the current keyframe.
struct Offer {
  std::int32_t point = kNone;
  double distance = std::numeric_limits<double>::infinity();  ///< [px]
};

double disparity_sigma(const Point& point, const Eigen::Vector3d& ray_in_world, double z, double per_pixel) {
  const Eigen::Vector3d along = point.information_matrix().ldlt().solve(ray_in_world);
  const double depth_sigma = std::sqrt(std::max(0.0, ray_in_world.dot(along))) / ray_in_world.norm();
  return depth_sigma / (z * z * per_pixel);
}

}  // namespace

class PointCloud::Implementation {
 public:
  Implementation(const Config& config, const PointCloudOptions& options) : config_(config), options_(options) {}

  bool add(const StereoFrame& frame, const FrameResult& result, const StereoOdometry& odometry);
  void correct(const std::function<std::optional<Eigen::Isometry3d>(int)>& world_from_left);
  template <class Visit>
  void for_each_seen(const Visit& visit) const {
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (points_[i].views >= options_.min_views) visit(i);
  }
  const std::vector<Point>& all() const { return points_; }
  const std::vector<CloudView>& views() const { return views_; }
  std::size_t dropped() const { return dropped_; }

 private:
  using Measured = std::vector<std::optional<points::MeasuredPoint>>;

  void offer(const StereoRig& rig, const StereoEdges& edges, const Measured& measured);
  void consider(std::int32_t index, const pose::ImageEdge& seen, double depth, const StereoEdges& edges,
                const Measured& measured);
  void merge(const points::MeasuredPoint& measured, std::int32_t index);
  void append(const points::MeasuredPoint& measured);
  template <class Keep>
  void keep_only(const Keep& keep);
  void make_room();
  std::int32_t number() const { return static_cast<std::int32_t>(views_.size()) - 1; }

  Config config_;
  PointCloudOptions options_;
  std::vector<Point> points_;
  std::vector<CloudView> views_;
  std::vector<Offer> offers_;  ///< one per edge of the current keyframe
  EdgeGrid grid_;
  std::size_t dropped_ = 0;
  int frames_ = 0;  ///< number of calls of add()
};

bool PointCloud::Implementation::add(const StereoFrame& frame, const FrameResult& result,
                                     const StereoOdometry& odometry) {
  const int number_of_frame = frames_++;
  if (!result.new_key_rig || !result.world_from_left || result.ambiguous_motion) return false;
  const StereoEdges& edges = odometry.stereo_edges();
  StereoRig rig = corrected_rig(odometry.rig(), result.rig);
  rig.left_undistortion = odometry.rig().left_undistortion;
  views_.push_back({number_of_frame, result.stamp_ns, *result.world_from_left});
  const Measured measured = points::measure_points(rig, edges, frame.left, config_);
  offer(rig, edges, measured);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (!measured[i]) continue;
    const points::MeasuredPoint& point = *measured[i];
    const double depth_error = point.inverse_depth_per_pixel * point.disparity_sigma / point.inverse_depth;
    if (offers_[i].point != kNone)
      merge(point, offers_[i].point);
    else if (!(depth_error > kMaxDepthError))
      append(point);
  }
  const std::int32_t oldest = number() - kMaxUnseenViews;
  keep_only([&](const Point& point) { return point.views >= options_.min_views || point.last_view >= oldest; });
  make_room();
  return true;
}

/// Assigns every point in view to the edge that it probably shows; an edge keeps the nearest point.
void PointCloud::Implementation::offer(const StereoRig& rig, const StereoEdges& edges, const Measured& measured) {
  offers_.assign(edges.size(), {});
  grid_.fill(edges.left_x, edges.left_y, rig.left.width, rig.left.height);
  const Eigen::Isometry3d left_from_world = views_.back().world_from_left.inverse();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Eigen::Vector3d at = left_from_world * points_[i].position;
    if (!(at.z() > 0)) continue;
    const auto seen =
        pose::project(rig.left, left_from_world, {points_[i].position, points_[i].tangent.cast<double>()});
    if (!seen || !(seen->pixel.x() >= 0 && seen->pixel.y() >= 0 && seen->pixel.x() <= rig.left.width - 1 &&
                   seen->pixel.y() <= rig.left.height - 1))
      continue;
    consider(static_cast<std::int32_t>(i), *seen, at.z(), edges, measured);
  }
}

void PointCloud::Implementation::consider(std::int32_t index, const pose::ImageEdge& seen, double depth,
                                          const StereoEdges& edges, const Measured& measured) {
  const Point& point = points_[static_cast<std::size_t>(index)];
  const Eigen::Vector3d ray = point.position - views_.back().world_from_left.translation();
  double sigma = -1;  // of the point's disparity; computed once an edge is near
  std::size_t best = 0;
  Offer found;
  grid_.for_each_near(seen.pixel.x(), seen.pixel.y(), [&](std::size_t i) {
    if (!measured[i]) return;
    const double direction = edges.left_direction[i], dx = edges.left_x[i] - seen.pixel.x(),
                 dy = edges.left_y[i] - seen.pixel.y();
    const double c = std::cos(direction), s = std::sin(direction);
    const double across = std::abs(c * dy - s * dx), along = std::abs(c * dx + s * dy);
    if (across > kAcross || along > kAlong) return;
    if (c * seen.direction.x() + s * seen.direction.y() < std::cos(kTurn)) return;
    if (sigma < 0) sigma = disparity_sigma(point, ray, depth, measured[i]->inverse_depth_per_pixel);
    const double own = measured[i]->disparity_sigma;
    const double apart = std::abs(1 / depth - measured[i]->inverse_depth) / measured[i]->inverse_depth_per_pixel;
    if (apart > kDeviations * std::sqrt(sigma * sigma + own * own + kPoseNoise * kPoseNoise)) return;
    const double distance = std::hypot(across, along);
    if (distance < found.distance) {
      found = {index, distance};
      best = i;
    }
  });
  if (found.point != kNone && found.distance < offers_[best].distance) offers_[best] = found;
}

/// Mean of both positions, weighted by information. Because the position along the curve is arbitrary, the measured
/// point is first moved along its tangent to the nearest position.
void PointCloud::Implementation::merge(const points::MeasuredPoint& measured, std::int32_t index) {
  Point& point = points_[static_cast<std::size_t>(index)];
  const Eigen::Isometry3d& world_from_left = views_.back().world_from_left;
  const Eigen::Matrix3d rotation = world_from_left.linear();
  const Eigen::Vector3d tangent = rotation * measured.tangent, measured_position = world_from_left * measured.position;
  const double longest = kMaxSlide * measured.metres_per_pixel;
  const Eigen::Vector3d slid =
      measured_position + std::clamp(tangent.dot(point.position - measured_position), -longest, longest) * tangent;
  const Eigen::Matrix3d known = point.information_matrix();
  const Eigen::Matrix3d added = rotation * measured.information * rotation.transpose();
  const Eigen::Matrix3d sum = known + added;
  point.position = sum.ldlt().solve(known * point.position + added * slid);
  point.set_information(sum);
  const auto views = static_cast<float>(point.views);
  point.tangent = (views * point.tangent + tangent.cast<float>()).normalized();
  point.grey = (views * point.grey + measured.grey) / (views + 1);
  ++point.views;
  point.last_view = number();
}

void PointCloud::Implementation::append(const points::MeasuredPoint& measured) {
  const Eigen::Isometry3d& world_from_left = views_.back().world_from_left;
  const Eigen::Matrix3d rotation = world_from_left.linear();
  Point& point = points_.emplace_back();
  point.position = world_from_left * measured.position;
  point.tangent = (rotation * measured.tangent).cast<float>();
  point.set_information(rotation * measured.information * rotation.transpose());
  point.grey = measured.grey;
  point.views = 1;
  point.last_view = number();
}

void PointCloud::Implementation::correct(const std::function<std::optional<Eigen::Isometry3d>(int)>& world_from_left) {
  std::vector<Eigen::Isometry3d> corrections;
  for (CloudView& view : views_) {
    const auto corrected = world_from_left(view.frame);
    corrections.push_back(corrected ? *corrected * view.world_from_left.inverse() : Eigen::Isometry3d::Identity());
    if (corrected) view.world_from_left = *corrected;
  }
  for (Point& point : points_) {
    const Eigen::Isometry3d& correction = corrections[static_cast<std::size_t>(point.last_view)];
    const Eigen::Matrix3d rotation = correction.linear();
    point.position = correction * point.position;
    point.tangent = (rotation * point.tangent.cast<double>()).cast<float>();
    point.set_information(rotation * point.information_matrix() * rotation.transpose());
  }
}

template <class Keep>
void PointCloud::Implementation::keep_only(const Keep& keep) {
  const auto is_dropped = [&](const Point& point) { return !keep(point); };
  points_.erase(std::remove_if(points_.begin(), points_.end(), is_dropped), points_.end());
}

/// If there are too many points, discards those with the fewest views until a tenth of the capacity is free; of points
/// with equal numbers of views, those observed longest ago.
void PointCloud::Implementation::make_room() {
  if (points_.size() <= options_.most_points) return;
  const std::size_t room = options_.most_points - options_.most_points / 10;
  const auto rank = [](const Point& point) { return std::pair(point.views, point.last_view); };
  std::vector<std::pair<std::int32_t, std::int32_t>> ranks;
  for (const Point& point : points_) ranks.push_back(rank(point));
  const auto first_kept = ranks.end() - static_cast<std::ptrdiff_t>(room);
  std::nth_element(ranks.begin(), first_kept, ranks.end());
  const auto least = *first_kept;
  auto alike = std::count(first_kept, ranks.end(), least);  // points to keep of the same rank, oldest first
  keep_only([&](const Point& point) {
    const bool keep = rank(point) > least || (rank(point) == least && alike-- > 0);
    dropped_ += !keep && point.views >= options_.min_views ? 1 : 0;
    return keep;
  });
}

PointCloud::PointCloud(const Config& config, const PointCloudOptions& options)
    : implementation_(std::make_unique<Implementation>(config, options)) {}
PointCloud::~PointCloud() = default;
bool PointCloud::add(const StereoFrame& frame, const FrameResult& result, const StereoOdometry& odometry) {
  return implementation_->add(frame, result, odometry);
}
void PointCloud::correct(const std::function<std::optional<Eigen::Isometry3d>(int)>& world_from_left) {
  implementation_->correct(world_from_left);
}
const std::vector<CloudView>& PointCloud::views() const { return implementation_->views(); }
std::size_t PointCloud::dropped() const { return implementation_->dropped(); }

std::vector<CloudPoint> PointCloud::points() const {
  std::vector<CloudPoint> result;
  implementation_->for_each_seen([&](std::size_t i) {
    const Point& point = implementation_->all()[i];
    result.push_back(
        {point.position, point.tangent, point.grey, points::largest_sigma(point.information_matrix()), point.views});
  });
  return result;
}

}  // namespace quadedge
