#pragma once
/// \file points_output.hpp  What a run writes beside its frames: the edges in space, some of them for its page, and
/// with --loops the corrected trajectory, the closures and the map.

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "output/run_record.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/map.hpp"
#include "quadedge/odometry.hpp"
#include "quadedge/point_cloud.hpp"

namespace quadedge::cli {

/// Which file of points to write, if any.
struct PointFiles {
  std::string ply;  ///< empty: none
  int min_views = PointCloudOptions().min_views;

  /// --points, --points-min-views.
  void declare(Options& options);
  /// Checks the file before long work. \throws UsageError, DataError for one that cannot be written, or that exists
  /// without `force`.
  void check(bool force) const;
};

/// Collects the edges of a run in space and writes them at the end; does nothing if none are requested.
class PointsOutput {
 public:
  PointsOutput(const PointFiles& files, const Config& config);
  /// Takes in the frame that was tracked last.
  void add(const FramePrefetcher::Frame& frame, const FrameResult& result, const StereoOdometry& odometry);
  /// Moves everything to the corrected poses of the frames.
  void correct(const Map& map);
  /// Writes what has been collected; nothing before the first keyframe. \throws DataError.
  void write();
  /// What was written; nothing if none are requested.
  std::optional<report::PointFacts> facts() const { return facts_; }

 private:
  PointFiles files_;
  std::unique_ptr<PointCloud> cloud_;  ///< null if none is requested
  std::optional<report::PointFacts> facts_;
};

/// The map of places beside the odometry of a run, with --loops.
class LoopOutput {
 public:
  explicit LoopOutput(StereoOdometry& odometry) : map_(odometry) {}

  /// Takes in the frame that was tracked last.
  void add(const FrameResult& result);
  /// Ends the comparisons, after the last frame. `after_error`: those that a lost device cannot make are left out.
  /// \throws DeviceError. \returns the map
  const Map& finish(bool after_error);
  /// Writes trajectory_map.txt and loops.csv and, unless its name is empty, a map file. \throws DataError. \returns
  /// what they hold
  report::LoopFacts write(const std::string& folder, const std::string& saved_map) const;

 private:
  Map map_;
  double total_ms_ = 0;
  std::vector<double> latencies_ms_;  ///< of all frames, with the time of the map
};

/// A bounded number of stereo edges of keyframes, evenly spread over the run. They are inliers of the motion of their
/// frame, so that few of them are mismatched. `run --points` writes all edges.
class EdgeSample {
 public:
  /// Takes in the frame that was tracked last, if it became the keyframe.
  void add(const StereoOdometry& odometry, const FrameResult& result);
  /// edges.csv: frame, x_m, y_m, z_m in the world (the first left camera), 3 decimals.
  std::string csv() const;

 private:
  struct Point {
    int frame;
    Eigen::Vector3d position;  ///< [m]
  };
  void thin();

  std::vector<Point> points_;
  std::size_t per_frame_ = 2500;
  int frames_ = 0;
};

}  // namespace quadedge::cli
