/// \file draw_trajectory.cpp  Picture of a trajectory from above.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "report/canvas.hpp"
#include "report/drawing.hpp"

namespace quadedge::report {
namespace {

constexpr int kWidth = 1000, kHeight = 800;                      // px
constexpr int kLeft = 90, kRight = 30, kTop = 80, kBottom = 70;  // margins of the plot [px]
constexpr double kSmallestExtent = 1e-3;                         // m; a rig at rest still gets axes
const cv::Scalar kInk(40, 40, 40), kGrid(225, 225, 225), kTruth(150, 150, 150), kEstimate(200, 90, 20),
    kStart(60, 140, 30);

/// Points (x, z) of a trajectory, one list per segment [m].
std::vector<std::vector<cv::Point2d>> segments_from_above(const Trajectory& trajectory) {
  std::vector<std::vector<cv::Point2d>> segments;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (i == 0 || trajectory[i].segment != trajectory[i - 1].segment) segments.emplace_back();
    const auto& position = trajectory[i].world_from_left.translation();
    segments.back().emplace_back(position.x(), position.z());
  }
  return segments;
}

/// Points (x, z) of a trajectory [m].
std::vector<cv::Point2d> from_above(const Trajectory& trajectory) {
  std::vector<cv::Point2d> points;
  for (const auto& pose : trajectory) {
    points.emplace_back(pose.world_from_left.translation().x(), pose.world_from_left.translation().z());
  }
  return points;
}

/// The truth in the estimate's world: equal poses at the estimate's first stamp, cut to the estimate's duration.
Trajectory moved_to_estimate(const Trajectory& truth, const Trajectory& estimate) {
  Trajectory moved;
  if (truth.empty() || estimate.empty()) return moved;
  const auto nearest = [](const Trajectory& poses, std::int64_t stamp) {
    return std::min_element(poses.begin(), poses.end(), [&](const auto& a, const auto& b) {
      return std::abs(a.stamp_ns - stamp) < std::abs(b.stamp_ns - stamp);
    });
  };
  const auto first_truth = nearest(truth, estimate.front().stamp_ns);
  const auto first_estimate = nearest(estimate, first_truth->stamp_ns);
  const auto last_truth = nearest(truth, estimate.back().stamp_ns);
  const Eigen::Isometry3d estimate_from_truth =
      first_estimate->world_from_left * first_truth->world_from_left.inverse();
  for (auto pose = first_truth; pose <= last_truth; ++pose) {
    moved.push_back({pose->stamp_ns, estimate_from_truth * pose->world_from_left});
  }
  return moved;
}

/// 1, 2 or 5 times a power of ten, so that about eight steps cover `extent`.
double tick_step(double extent) {
  const double raw = extent / 8;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw) return factor * power;
  }
  return 10 * power;
}

/// Metres to picture pixels with one scale for both axes.
struct Plot {
  double centre_x, centre_z, pixels_per_metre;
  cv::Point2d position(const cv::Point2d& point) const {
    return {kLeft + 0.5 * (kWidth - kLeft - kRight) + (point.x - centre_x) * pixels_per_metre,
            kTop + 0.5 * (kHeight - kTop - kBottom) - (point.y - centre_z) * pixels_per_metre};
  }
};

Plot fit(const std::vector<cv::Point2d>& points) {
  double low_x = 0, high_x = 0, low_z = 0, high_z = 0;
  for (const auto& point : points) {
    low_x = std::min(low_x, point.x), high_x = std::max(high_x, point.x);
    low_z = std::min(low_z, point.y), high_z = std::max(high_z, point.y);
  }
  const double plot_width = kWidth - kLeft - kRight, plot_height = kHeight - kTop - kBottom;
  const double scale = std::min(plot_width / std::max(high_x - low_x, kSmallestExtent),
                                plot_height / std::max(high_z - low_z, kSmallestExtent));
  return {0.5 * (low_x + high_x), 0.5 * (low_z + high_z), 0.88 * scale};
}

void draw_axes(cv::Mat& picture, const Plot& plot) {
  const double half_x = 0.5 * (kWidth - kLeft - kRight) / plot.pixels_per_metre;
  const double half_z = 0.5 * (kHeight - kTop - kBottom) / plot.pixels_per_metre;
  const double step = tick_step(2 * half_z);
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  const int left = kLeft, right = kWidth - kRight, top = kTop, bottom = kHeight - kBottom;
  for (double k = std::ceil((plot.centre_x - half_x) / step); k * step <= plot.centre_x + half_x; ++k) {
    const int x = static_cast<int>(std::lround(plot.position({k * step, 0}).x));
    cv::line(picture, {x, top}, {x, bottom}, kGrid);
    const std::string label = fixed(k == 0 ? 0.0 : k * step, decimals);
    put_text(picture, label, x - text_width(label, 0.45) / 2, bottom + 20, kInk, 0.45);
  }
  for (double k = std::ceil((plot.centre_z - half_z) / step); k * step <= plot.centre_z + half_z; ++k) {
    const int y = static_cast<int>(std::lround(plot.position({0, k * step}).y));
    cv::line(picture, {left, y}, {right, y}, kGrid);
    const std::string label = fixed(k == 0 ? 0.0 : k * step, decimals);
    put_text(picture, label, left - 8 - text_width(label, 0.45), y + 5, kInk, 0.45);
  }
  cv::rectangle(picture, {left, top}, {right, bottom}, kInk);
  put_text(picture, "x to the right [m]", (left + right) / 2 - 70, kHeight - 22, kInk);
  put_text(picture, "z forward [m]", 8, top - 14, kInk);
}

void draw_path(cv::Mat& picture, const Plot& plot, const std::vector<cv::Point2d>& points, const cv::Scalar& colour,
               int width) {
  constexpr int kShift = 4;
  const auto fine = [&](const cv::Point2d& point) {
    const cv::Point2d position = plot.position(point) * (1 << kShift);
    return cv::Point(static_cast<int>(std::lround(position.x)), static_cast<int>(std::lround(position.y)));
  };
  for (std::size_t i = 1; i < points.size(); ++i) {
    cv::line(picture, fine(points[i - 1]), fine(points[i]), colour, width, cv::LINE_AA, kShift);
  }
  for (const auto& point : points)
    cv::circle(picture, fine(point), (width + 1) << kShift, colour, cv::FILLED, cv::LINE_AA, kShift);
}

/// One row between title and plot, where it hides nothing.
void draw_legend(cv::Mat& picture, const std::vector<std::pair<std::string, cv::Scalar>>& entries) {
  int width = 0;
  for (const auto& entry : entries) width += 38 + text_width(entry.first) + 30;
  int x = (kLeft + kWidth - kRight - width + 30) / 2;
  const int baseline = kTop - 18;
  for (const auto& entry : entries) {
    cv::line(picture, {x, baseline - 5}, {x + 28, baseline - 5}, entry.second, 3, cv::LINE_AA);
    x = put_text(picture, entry.first, x + 38, baseline, kInk) + 30;
  }
}

}  // namespace

void draw_trajectory(const std::string& path, const Trajectory& estimate, const Trajectory& truth,
                     const std::string& title) {
  const auto estimate_points = from_above(estimate);
  const auto truth_points = from_above(moved_to_estimate(truth, estimate));
  auto all = estimate_points;
  all.insert(all.end(), truth_points.begin(), truth_points.end());
  const Plot plot = fit(all);

  cv::Mat picture(kHeight, kWidth, CV_8UC3, cv::Scalar(255, 255, 255));
  draw_axes(picture, plot);
  put_text(picture, title, kWidth / 2 - text_width(title, 0.6) / 2, 28, kInk, 0.6);
  std::vector<std::pair<std::string, cv::Scalar>> legend = {{"estimate", kEstimate}};
  if (!truth_points.empty()) {
    draw_path(picture, plot, truth_points, kTruth, 5);
    legend.emplace_back("ground truth, origin-aligned", kTruth);
  }
  for (const auto& segment : segments_from_above(estimate)) draw_path(picture, plot, segment, kEstimate, 2);
  if (!estimate_points.empty()) {
    const auto start = plot.position(estimate_points.front());
    cv::circle(picture, {static_cast<int>(std::lround(start.x)), static_cast<int>(std::lround(start.y))}, 6, kStart, 2,
               cv::LINE_AA);
    legend.emplace_back("start", kStart);
  }
  draw_legend(picture, legend);
  write_png(path, picture);
}

}  // namespace quadedge::report
