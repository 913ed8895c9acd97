#pragma once
/// \file measured_points.hpp  Stereo edges of one frame as points with covariances (doc/method.md section 9).

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"

namespace quadedge::points {

/// A stereo edge in the left camera frame.
struct MeasuredPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d tangent = Eigen::Vector3d::UnitX();
  /// Inverse covariance of the position [1/m^2]. The position is known to half a pixel along the edge, the segment of
  /// curve that an edge represents; across it and in depth, the noise model applies.
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  double inverse_depth = 0;            ///< [1/m]
  double inverse_depth_per_pixel = 0;  ///< per pixel of disparity [1/(m px)]
  double disparity_sigma = 0;          ///< standard deviation along the epipolar line [px]
  double metres_per_pixel = 0;         ///< displacement across the ray per pixel of the left image
  float grey = 0;                      ///< 0 to 255
};

/// One entry per stereo edge; nothing if pose::measure() finds no point. `image`: the recorded left image.
std::vector<std::optional<MeasuredPoint>> measure_points(const StereoRig& rig, const StereoEdges& edges,
                                                         const ImageView& image, const Config& config);

/// Standard deviation in the least certain direction [m].
float largest_sigma(const Eigen::Matrix3d& information);

}  // namespace quadedge::points
