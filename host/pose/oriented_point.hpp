#pragma once
/// \file oriented_point.hpp  A stereo edge as a point with a tangent in space, and back (doc/method.md section 5, paper
/// section 3).

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "quadedge/camera.hpp"

namespace quadedge::pose {

/// A point with a tangent, in the left camera's frame of its time.
struct OrientedPoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< metres, z > 0
  Eigen::Vector3d tangent =
      Eigen::Vector3d::UnitX();  ///< unit norm; its projection has the left edge's direction, sign included
};

/// One edge in each image of a rig. Pixels; directions in radians, (cos, sin) of the tangent in the image.
struct StereoObservation {
  Eigen::Vector2d left = Eigen::Vector2d::Zero(), right = Eigen::Vector2d::Zero();
  double left_direction = 0, right_direction = 0;
  double left_scale_drift = 0;  ///< of the left edge, see EdgeSet::scale_drift
};

/// A stereo edge in the quantities whose noise is Gaussian: the left pixel is exact by definition (it says which point
/// of the scene is meant), what is measured is the inverse depth along its ray and the slope of the curve in depth.
///   point = ray / inverse_depth,   tangent ~ direction + slope * ray.
struct StereoMeasurement {
  Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();  ///< K^-1 (x, y, 1) of the left pixel
  double inverse_depth = 0;                        ///< 1 / z [1/m]
  double inverse_depth_per_pixel = 0;  ///< its change per pixel along the right image's epipolar line, >= 0 [1/(m px)]
  double epipolar_sine = 0;            ///< |sin| of the angle between right edge and epipolar line, in the image
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< K^-1 (cos, sin, 0) of the left edge, unit norm
  /// How far the left edge moves per unit of log(scale), as a step of its ray; see EdgeSet::scale_drift.
  Eigen::Vector2d scale_drift = Eigen::Vector2d::Zero();
  double slope = 0;             ///< depth slope of the tangent, no unit
  double slope_per_radian = 0;  ///< its standard deviation when both directions have one of 1 rad
  /// Unit normals, left camera's frame, of the planes through a camera's centre and the tangent as that camera sees it.
  Eigen::Vector3d left_normal = Eigen::Vector3d::UnitY(), right_normal = Eigen::Vector3d::UnitY();

  OrientedPoint oriented_point() const { return {ray / inverse_depth, (direction + slope * ray).normalized()}; }
};

/// Measures a stereo edge. The point lies exactly on the left ray; its depth is the one whose projection into the right
/// image is nearest to the right pixel along the epipolar line. This beats the midpoint of the two rays for edges: the
/// right pixel was placed on that line, so only its position along the line carries information, and any rig works,
/// vertical baselines and converging cameras included. The tangent is the intersection of the two planes that the image
/// tangents span with their camera centres (n1 x n2 of doc/method.md section 5, written so that its sign agrees with
/// the left direction, which carries contrast). \param min_epipolar_angle radians; an edge nearer than this to its
/// epipolar line in either IMAGE has no tangent and hardly
///   a depth. (The angle between the two planes themselves is about baseline / depth times its sine: a few tenths of a
///   degree for a perfectly placed far edge. It cannot serve as the test.)
/// \returns nothing for a depth that is not positive and finite in both cameras, for an edge along its epipolar line,
/// and for
///   a left pixel on the epipole.
std::optional<StereoMeasurement> measure(const StereoRig& rig, const StereoObservation& observation,
                                         double min_epipolar_angle);

/// The point and tangent of measure(). Pixels and radians in, metres out.
std::optional<OrientedPoint> reconstruct(const StereoRig& rig, const StereoObservation& observation,
                                         double min_epipolar_angle);

/// An edge as a camera sees it.
struct ImageEdge {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< unit norm
};

/// Projects a point with tangent into a camera. `camera_from_points`: the camera's frame from the one of the point.
/// \returns nothing for a point that is not in front of the camera, or a tangent that points at its centre.
std::optional<ImageEdge> project(const PinholeCamera& camera, const Eigen::Isometry3d& camera_from_points,
                                 const OrientedPoint& oriented_point);

/// Standard deviation of the depth z [m] for one of `sigma` px along the right epipolar line: z^2 *
/// inverse_depth_per_pixel * sigma, which for a rectified rig is z^2 sigma / (f b).
inline double depth_sigma(const StereoMeasurement& measurement, double sigma) {
  return measurement.inverse_depth_per_pixel * sigma / (measurement.inverse_depth * measurement.inverse_depth);
}

}  // namespace quadedge::pose
