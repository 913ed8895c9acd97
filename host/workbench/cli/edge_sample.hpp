#pragma once
/// \file edge_sample.hpp  Some of the edges of a run in space, for its page.

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "quadedge/odometry.hpp"

namespace quadedge::cli {

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
