#pragma once
/// \file oriented_point.hpp  Conversion between a stereo edge and a point with a tangent in space (doc/method.md
/// section 5, paper section 3).

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::pose {

/// A point with a tangent, in the left camera frame at its time.
struct OrientedPoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< metres, z > 0
  Eigen::Vector3d tangent =
      Eigen::Vector3d::UnitX();  ///< unit length; its projection has the direction of the left edge, including the sign
};

/// One edge in each image of a rig. Positions in pixels, directions in radians: (cos, sin) is the tangent in the image.
struct StereoObservation {
  Eigen::Vector2d left = Eigen::Vector2d::Zero(), right = Eigen::Vector2d::Zero();
  double left_direction = 0, right_direction = 0;
  double left_scale_shift = 0;  ///< of the left edge, see EdgeSet::scale_shift
};

/// What is observed of edge `i`.
StereoObservation observation_of(const StereoEdges& edges, std::size_t i);

/// A stereo edge in terms of quantities with Gaussian noise. The left pixel is exact by definition (it selects the
/// scene point). Measured are the inverse depth along its ray and the depth slope of the curve:
///   point = ray / inverse_depth,   tangent ~ direction + slope * ray.
struct StereoMeasurement {
  Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();  ///< K^-1 (x, y, 1) of the left pixel
  double inverse_depth = 0;                        ///< 1 / z [1/m]
  double inverse_depth_per_pixel = 0;  ///< its change per pixel along the right epipolar line, >= 0 [1/(m px)]
  double epipolar_sine = 0;            ///< |sin| of the angle between right edge and epipolar line in the image
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< K^-1 (cos, sin, 0) of the left edge, unit length
  /// Displacement of the left edge per unit of log(scale), as a step of its ray; see EdgeSet::scale_shift.
  Eigen::Vector2d scale_shift = Eigen::Vector2d::Zero();
  double slope = 0;             ///< depth slope of the tangent
  double slope_per_radian = 0;  ///< standard deviation of the slope if both directions have one of 1 rad
  /// Unit directions of both edges in their images.
  Eigen::Vector2f left_edge = Eigen::Vector2f::UnitX(), right_edge = Eigen::Vector2f::UnitX();
  /// Unit normals, in the left camera frame, of the planes through a camera centre and the tangent as seen by that
  /// camera.
  Eigen::Vector3d left_normal = Eigen::Vector3d::UnitY(), right_normal = Eigen::Vector3d::UnitY();

  OrientedPoint oriented_point() const { return {ray / inverse_depth, (direction + slope * ray).normalized()}; }
};

/// Measures a stereo edge. The point lies exactly on the left ray, at the depth whose projection into the right image
/// is nearest to the right pixel along the epipolar line. For edges, this is more accurate than the midpoint of the two
/// rays, because the right pixel was placed on that line and only its position along the line carries information. It
/// works for any rig, including vertical baselines and converging cameras. The tangent is the intersection of the two
/// planes spanned by the image tangents and their camera centres (n1 x n2 of doc/method.md section 5, written so that
/// its sign agrees with the left direction, which encodes contrast).
/// \param min_epipolar_angle [rad]; an edge closer than this to the direction of its epipolar line in either IMAGE has
/// no tangent and hardly any depth information. (The angle between the two planes is about baseline / depth times its
/// sine, a few tenths of a degree even for a perfectly located distant edge, and is therefore unsuitable as a
/// criterion.)
/// \returns nothing for a depth that is not positive and finite in both cameras, for an edge along its epipolar line,
/// and for a left pixel at the epipole
std::optional<StereoMeasurement> measure(const StereoRig& rig, const StereoObservation& observation,
                                         double min_epipolar_angle);

/// An edge as seen by a camera.
struct ImageEdge {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< unit length
};

/// Projects a point with tangent into a camera. `camera_from_points`: from the frame of the point to that of the
/// camera.
/// \returns nothing for a point that is not in front of the camera, or a tangent that points at its centre
std::optional<ImageEdge> project(const PinholeCamera& camera, const Eigen::Isometry3d& camera_from_points,
                                 const OrientedPoint& oriented_point);

/// Standard deviation of the depth z [m] for `sigma` px along the right epipolar line: z^2 * inverse_depth_per_pixel *
/// sigma, which for a rectified rig is z^2 sigma / (f b).
inline double depth_sigma(const StereoMeasurement& measurement, double sigma) {
  return measurement.inverse_depth_per_pixel * sigma / (measurement.inverse_depth * measurement.inverse_depth);
}

}  // namespace quadedge::pose
