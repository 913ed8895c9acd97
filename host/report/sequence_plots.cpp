#include "report/sequence_plots.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/number_text.hpp"
#include "report/statistics.hpp"
#include "report/svg_plot.hpp"

namespace quadedge::report {
namespace {

constexpr int kTrajectoryWidth = 610, kTrajectoryHeight = 360, kErrorPlotWidth = 302, kErrorPlotHeight = 260,
              kFramePlotWidth = 408;  // px
constexpr double kNanosecond = 1e-9;  // s
constexpr double kSameStamp = 1e-5;   // s; what a stamp may lose when it is read as a double
constexpr const char* kTime = "time since the first frame [s]";
constexpr const char* kKeyRig = "new key stereo rig";
using PerPose = TrajectoryEvaluation::PerPose;

/// Time of a stamp on the plots' axis [s].
double seconds(std::int64_t stamp_ns, double start) { return static_cast<double>(stamp_ns) * kNanosecond - start; }

double start_of(const SequenceResults& results) {
  return results.frames.stamp_s.empty() ? 0 : results.frames.stamp_s.front();
}

std::vector<double> times(const SequenceResults& results) {
  std::vector<double> times;
  for (const double stamp : results.frames.stamp_s) times.push_back(stamp - start_of(results));
  return times;
}

/// Times at which the key stereo rig changed.
std::vector<double> key_rig_times(const SequenceResults& results) {
  std::vector<double> changes;
  const auto all = times(results);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (results.frames.new_key_rig[i]) changes.push_back(all[i]);
  }
  return changes;
}

/// The points of a curve at given times; where it has none, nothing.
Curve at_times(const Curve& curve, const std::vector<double>& curve_times, const std::vector<double>& wanted) {
  Curve found;
  for (const double time : wanted) {
    const auto near = std::lower_bound(curve_times.begin(), curve_times.end(), time - kSameStamp);
    if (near == curve_times.end() || *near > time + kSameStamp) continue;
    const auto i = static_cast<std::size_t>(near - curve_times.begin());
    found.xs.push_back(curve.xs[i]);
    found.ys.push_back(curve.ys[i]);
  }
  return found;
}

/// The k for which every k-th of `count` things are at most `limit`.
std::size_t step_for(std::size_t count, int limit) {
  const auto most = static_cast<std::size_t>(limit);
  return std::max<std::size_t>(1, (count + most - 1) / most);
}

/// Every k-th point, and the last one.
Curve every_kth(const Curve& curve, int limit) {
  const std::size_t step = step_for(curve.xs.size(), limit);
  Curve kept;
  for (std::size_t i = 0; i < curve.xs.size(); ++i) {
    if (i % step != 0 && i + 1 != curve.xs.size()) continue;
    kept.xs.push_back(curve.xs[i]);
    kept.ys.push_back(curve.ys[i]);
  }
  return kept;
}

/// A trajectory seen from above (x, z), or from the side (z, height).
Curve projected(const Trajectory& poses, bool above) {
  Curve curve;
  for (const auto& pose : poses) {
    const Eigen::Vector3d position = pose.world_from_left.translation();
    curve.xs.push_back(above ? position.x() : position.z());
    curve.ys.push_back(above ? position.z() : -position.y());
  }
  return curve;
}

std::string trajectory_plot(const SequenceResults& results, int points, bool above) {
  Plot plot;
  plot.title = above ? "Trajectory from above" : "Trajectory from the side";
  plot.x_label = above ? "x to the right [m]" : "z forward [m]";
  plot.y_label = above ? "z forward [m]" : "-y upward [m]";
  plot.equal_units = true;
  plot.width = kTrajectoryWidth;
  plot.height = kTrajectoryHeight;
  for (const auto& trajectory : results.trajectories) {
    const Curve curve = every_kth(projected(trajectory.poses, above), points);
    plot.add_line(trajectory.name, curve.xs, curve.ys);
  }
  if (!results.truth.empty()) {
    const Curve curve = every_kth(projected(results.truth, above), points);
    plot.add_line("ground truth", curve.xs, curve.ys, true);
  }
  std::vector<double> own_times;
  for (const auto& pose : results.trajectories.front().poses)
    own_times.push_back(seconds(pose.stamp_ns, start_of(results)));
  const Curve own = projected(results.trajectories.front().poses, above);
  const Curve changes = every_kth(at_times(own, own_times, key_rig_times(results)), points);
  if (!changes.xs.empty()) plot.add_points(kKeyRig, changes.xs, changes.ys);
  return plot.svg();
}

std::string error_plot(const SequenceResults& results, int points, const std::string& title, const std::string& label,
                       double PerPose::*error) {
  Plot plot;
  plot.width = kErrorPlotWidth;
  plot.height = kErrorPlotHeight;
  plot.title = title;
  plot.x_label = kTime;
  plot.y_label = label;
  plot.y_low = 0;
  Curve own;
  for (std::size_t i = 0; i < results.trajectories.size(); ++i) {
    const auto& trajectory = results.trajectories[i];
    if (!trajectory.evaluation) continue;
    Curve curve;
    for (const auto& pose : trajectory.evaluation->per_pose) {
      curve.xs.push_back(seconds(pose.stamp_ns, start_of(results)));
      curve.ys.push_back(pose.*error);
    }
    const Curve drawn = thinned(curve, points);
    plot.add_line(trajectory.name, drawn.xs, drawn.ys);
    if (i == 0) own = curve;
  }
  const Curve changes = every_kth(at_times(own, own.xs, key_rig_times(results)), points);
  if (!changes.xs.empty()) plot.add_points(kKeyRig, changes.xs, changes.ys);
  return plot.svg();
}

/// Some of the counts over time, by their names in frames.csv and on the plot.
Plot count_plot(const SequenceResults& results, int points,
                const std::vector<std::pair<std::string, std::string>>& counts) {
  Plot plot;
  plot.width = kFramePlotWidth;
  plot.x_label = kTime;
  plot.y_low = 0;
  for (const auto& [name, label] : counts) {
    for (const auto& column : results.frames.counts) {
      if (column.first != name) continue;
      const Curve curve = thinned({times(results), column.second}, points);
      plot.add_line(label, curve.xs, curve.ys);
    }
  }
  return plot;
}

std::string edge_plot(const SequenceResults& results, int points) {
  Plot plot =
      count_plot(results, points, {{"edges_left", "left"}, {"edges_right", "right"}, {"stereo_edges", "stereo edges"}});
  plot.title = "Edges";
  plot.y_label = "edges per frame";
  return plot.svg();
}

std::string quad_plot(const SequenceResults& results, int points) {
  Plot plot = count_plot(results, points, {{"quads", "quads"}, {"inliers", "inliers"}});
  plot.title = "Quads, and the inliers of the pose";
  plot.y_label = "quads per frame";
  const auto all = times(results);
  Curve inliers{all, std::vector<double>(all.size(), 0.0)}, lost;
  for (const auto& column : results.frames.counts) {
    if (column.first == "inliers") inliers.ys = column.second;
  }
  const Curve changes = every_kth(at_times(inliers, all, key_rig_times(results)), points);
  if (!changes.xs.empty()) plot.add_points(kKeyRig, changes.xs, changes.ys);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (results.frames.status[i].rfind("lost", 0) != 0) continue;
    lost.xs.push_back(all[i]);
    lost.ys.push_back(0);
  }
  lost = every_kth(lost, points);
  if (!lost.xs.empty()) plot.add_points("lost frame", lost.xs, lost.ys);
  return plot.svg();
}

/// Each frame's latency as a stack of its stages, and what is left of it on top.
std::string latency_plot(const SequenceResults& results, int points) {
  constexpr double kOutlier = 3;  // times the 95th percentile
  Plot plot;
  plot.width = kFramePlotWidth;
  plot.x_label = kTime;
  plot.y_label = "latency [ms]";
  plot.title = "Latency by stage";
  plot.y_low = 0;
  const auto& frames = results.frames;
  const double usual = percentile(frames.latency_ms, 0.95), largest = percentile(frames.latency_ms, 1.0);
  if (largest > kOutlier * usual) {
    plot.y_high = 1.5 * usual;
    plot.title += " (largest " + significant(largest) + " ms)";
  }
  const auto all = times(results);
  // All layers are cut from the same frames, so that they lie on one another.
  const std::size_t step = step_for(all.size(), points);
  std::vector<double> xs, floor, total;
  for (std::size_t i = 0; i < all.size(); i += step) {
    xs.push_back(all[i]);
    floor.push_back(0);
    total.push_back(frames.latency_ms[i]);
  }
  for (const auto& [name, values] : frames.stages_ms) {
    std::vector<double> top = floor;
    for (std::size_t k = 0; k < top.size(); ++k) top[k] += std::isfinite(values[k * step]) ? values[k * step] : 0;
    plot.add_band(name, xs, floor, top);
    floor = top;
  }
  for (std::size_t k = 0; k < total.size(); ++k) total[k] = std::max(total[k], floor[k]);
  plot.add_band("rest", xs, floor, total);
  return plot.svg();
}

}  // namespace

Curve thinned(const Curve& curve, int limit) {
  const std::size_t count = curve.xs.size(), stretches = static_cast<std::size_t>(std::max(limit, 4)) / 2;
  if (count <= 2 * stretches) return curve;
  Curve kept;
  for (std::size_t k = 0; k < stretches; ++k) {
    const std::size_t begin = k * count / stretches, end = (k + 1) * count / stretches;
    std::size_t low = begin, high = begin;
    for (std::size_t i = begin; i < end; ++i) {
      if (!std::isfinite(curve.ys[i])) continue;
      if (!(curve.ys[i] >= curve.ys[low])) low = i;  // also where ys[low] is NaN
      if (!(curve.ys[i] <= curve.ys[high])) high = i;
    }
    for (const std::size_t i : {std::min(low, high), std::max(low, high)}) {
      kept.xs.push_back(curve.xs[i]);
      kept.ys.push_back(curve.ys[i]);
    }
  }
  return kept;
}

std::vector<std::string> trajectory_plots(const SequenceResults& results, int points) {
  return {trajectory_plot(results, points, true), trajectory_plot(results, points, false)};
}

std::vector<std::string> error_plots(const SequenceResults& results, int points) {
  if (results.truth.empty()) return {};
  return {
      error_plot(results, points, "Absolute error of the position", "APE translation [m]", &PerPose::ape_translation_m),
      error_plot(results, points, "Absolute error of the orientation", "APE rotation [deg]",
                 &PerPose::ape_rotation_deg),
      error_plot(results, points, "Error of the position per frame", "RPE translation [m]",
                 &PerPose::rpe_translation_m),
      error_plot(results, points, "Error of the orientation per frame", "RPE rotation [deg]",
                 &PerPose::rpe_rotation_deg)};
}

std::vector<std::string> frame_plots(const SequenceResults& results, int points) {
  return {edge_plot(results, points), quad_plot(results, points), latency_plot(results, points)};
}

}  // namespace quadedge::report
