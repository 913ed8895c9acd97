#pragma once
/// \file residuals.hpp  The residuals of one quad, of its positions and of its tangent, with their Jacobians and the
/// noise of edge measurements (doc/method.md section 6).

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <tuple>

#include "geometry/lanes.hpp"
#include "geometry/stereo_numbers.hpp"
#include "motion/quads.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge::pose {

/// Standard deviations of an edge's measurement.
struct NoiseModel {
  /// \param disparity_px see `disparity`
  explicit NoiseModel(const PoseConfig& config, double disparity_px = 0);
  double across, along;  ///< of an edge's position across and along itself [px]
  double disparity;      ///< of the error that a quad's disparities at both times share, left by the calibration [px]
  /// Standard deviation along an edge that represents `half_length` px of its curve to both sides, relative to the same
  /// point at another time. \param scale factor by which the other standard deviations are wrong; this one is exact [1]
  double along_in_time(double half_length, double scale) const;
  double direction;  ///< of an edge's direction [rad]
  /// Standard deviation along the epipolar line, for an edge that crosses the line at an angle of sine `epipolar_sine`
  /// [px].
  double on_epipolar_line(double epipolar_sine) const;
};

/// Positions of a quad.
///
/// The previous frame defines the point (its left pixel) and measures its depth (inverse depth, noisy). The current
/// frame measures the left pixel, accurately across the edge and poorly along it, and a second inverse depth from its
/// right image. The right image adds information only along the epipolar line and is therefore used as inverse depth;
/// using both of its coordinates would count the noise of the left image twice. The true inverse depth of the point is
/// an unknown, so that the depths of both frames are treated alike and forward and backward errors have equal weights;
/// refinement.hpp gives the benefit.
struct ReprojectionTerm {
  double ray_x, ray_y;                     ///< previous left pixel as a ray (x, y, 1), previous left frame
  double inverse_depth;                    ///< previous, as measured [1/m]
  double inverse_depth_sigma;              ///< its standard deviation [1/m]
  double inverse_depth_per_pixel;          ///< its change along the right epipolar line [1/(m px)]
  double current_inverse_depth_per_pixel;  ///< the same for the current edge
  double current_x, current_y;             ///< current left pixel as a ray (x, y, 1)
  double scale_shift_x, scale_shift_y;     ///< step of that ray per unit of log(scale), mean of both left edges
  /// Unit normal of the edge in the current left image, divided by its sigma, and the same of the tangent, with image
  /// axes multiplied by the focal lengths, so that they apply to rays.
  double across_x, across_y, along_x, along_y;
  double current_inverse_depth;         ///< as measured [1/m]
  double current_inverse_depth_weight;  ///< 1 / its standard deviation [m]
  double disparity_variance;            ///< of the error that the disparities at both times share [px^2]

  template <class Self>
  [[gnu::always_inline]] static auto members(Self& self) {
    return std::tie(self.ray_x, self.ray_y, self.inverse_depth, self.inverse_depth_sigma, self.inverse_depth_per_pixel,
                    self.current_inverse_depth_per_pixel, self.current_x, self.current_y, self.scale_shift_x,
                    self.scale_shift_y, self.across_x, self.across_y, self.along_x, self.along_y,
                    self.current_inverse_depth, self.current_inverse_depth_weight, self.disparity_variance);
  }
};

/// \param quad its row in `quads` \param left the current camera \param scale see NoiseModel::along_in_time()
ReprojectionTerm make_reprojection_term(const QuadObservations& quads, std::size_t quad, const PinholeCamera& left,
                                        const NoiseModel& noise, double scale = 1.0);

/// The three residuals of a quad, or their derivatives with respect to one unknown, in standard deviations.
struct Residuals {
  double across, along;  ///< of the edge in the current left image
  double inverse_depth;  ///< in the current left frame
};

[[gnu::always_inline]] inline double dot(const Residuals& a, const Residuals& b) {
  return a.across * b.across + a.along * b.along + a.inverse_depth * b.inverse_depth;
}

/// Residuals with derivatives. A LEFT perturbation of current_from_previous by a rotation w [rad] and a translation v
/// [m], exp(w) R and exp(w) T + v, moves the homogeneous point y by w x y + rho v to first order. A residual with
/// derivative g with respect to y has the derivatives y x g with respect to w and rho g with respect to v.
struct ReprojectionResidual {
  bool in_front;  ///< whether the point is in front of the current left camera; if not, the other members are undefined
  Residuals value;
  Vector3 across_by_point, along_by_point;  ///< with respect to the homogeneous point
  double inverse_depth_by_z;  ///< with respect to the third coordinate, the only one on which this residual depends
  Residuals by_depth;         ///< with respect to the depth unknown, in standard deviations of the previous depth
  Residuals by_offset;        ///< with respect to an offset of all right points along their epipolar lines [1/px]
};

/// With r the ray of the previous left pixel and rho its true inverse depth, the scene point times rho in the current
/// left frame is y = R r + rho T, regular for points at infinity too. With pi(y) = (y_x, y_y) / y_z, the residuals are
///   across:         a . (pi(y) - current ray - drift log(1 / y_z))      a: ReprojectionTerm::across_x, across_y
///   along:          b . (pi(y) - current ray - drift log(1 / y_z))      b: along_x, along_y
///   inverse depth:  (rho / y_z - current) / sigma.
/// 1 / y_z is the magnification of the scene in the image, whereas the scale of edge detection is fixed.
/// log(1 / z) is approximated by 2 (1 - z) / (1 + z), which is accurate to 1e-4 for a change of a tenth.
/// All operations are written such that loops over quads vectorise, with identical bits at every vector width.
/// \param point y, current left frame \param inverse_depth rho = measured + depth unknown * sigma; the unknown has a
/// standard normal prior [1/m] \param translation T [m]
[[gnu::always_inline]] inline ReprojectionResidual reprojection_residual(const ReprojectionTerm& term,
                                                                         const Vector3& point, double inverse_depth,
                                                                         const Vector3& translation) {
  ReprojectionResidual result;
  result.in_front = point.z > 0;
  const double inverse_z = 1.0 / (result.in_front ? point.z : 1.0);
  const double u = point.x * inverse_z, v = point.y * inverse_z;
  const double half_way = 2.0 / (1.0 + (result.in_front ? point.z : 1.0));
  const double growth = (1.0 - (result.in_front ? point.z : 1.0)) * half_way;  // log(1 / y_z)
  const double error_x = u - term.current_x - growth * term.scale_shift_x;
  const double error_y = v - term.current_y - growth * term.scale_shift_y;
  const double weight = term.current_inverse_depth_weight;
  result.value = {term.across_x * error_x + term.across_y * error_y, term.along_x * error_x + term.along_y * error_y,
                  (inverse_depth * inverse_z - term.current_inverse_depth) * weight};

  // Derivative of an axis with respect to the point: (a_x, a_y, -(a_x u + a_y v)) / y_z, plus the change of the
  // magnification with y_z.
  const auto by_point = [&](double axis_x, double axis_y) -> Vector3 {
    const double by_x = axis_x * inverse_z, by_y = axis_y * inverse_z;
    const double by_growth = axis_x * term.scale_shift_x + axis_y * term.scale_shift_y;
    return {by_x, by_y, -(by_x * u + by_y * v) + half_way * half_way * by_growth};
  };
  result.across_by_point = by_point(term.across_x, term.across_y);
  result.along_by_point = by_point(term.along_x, term.along_y);
  result.inverse_depth_by_z = -inverse_depth * inverse_z * inverse_z * weight;

  // The previous inverse depth moves the point along T and also appears in the third residual.
  const Residuals by_inverse_depth = {dot(result.across_by_point, translation), dot(result.along_by_point, translation),
                                      result.inverse_depth_by_z * translation.z + inverse_z * weight};
  const auto times = [&](double factor) -> Residuals {
    return {by_inverse_depth.across * factor, by_inverse_depth.along * factor, by_inverse_depth.inverse_depth * factor};
  };
  result.by_depth = times(term.inverse_depth_sigma);
  // An offset changes the inverse depths at both times.
  result.by_offset = times(term.inverse_depth_per_pixel);
  result.by_offset.inverse_depth -= weight * term.current_inverse_depth_per_pixel;
  return result;
}

/// Directions of a quad: the rotated previous tangent has to lie in the viewing planes of both current edges.
struct DirectionTerm {
  Vector3 tangent;     ///< previous tangent, direction + slope * ray, not of unit length; previous left frame
  double slope_sigma;  ///< standard deviation of `slope`
  /// Unit normals of the tangent's current viewing planes, divided by the sigma of the direction; current left frame.
  Vector3 left_normal, right_normal;

  template <class Self>
  [[gnu::always_inline]] static auto members(Self& self) {
    return std::tuple_cat(members_of(self.tangent), std::tie(self.slope_sigma), members_of(self.left_normal),
                          members_of(self.right_normal));
  }
};

/// \param quad its row in `quads`
DirectionTerm make_direction_term(const QuadObservations& quads, std::size_t quad, const NoiseModel& noise);

/// Deviation of the tangent from the left and the right viewing plane, in standard deviations.
struct DirectionResidual {
  double left, right;
  Vector3 left_by_rotation, right_by_rotation;  ///< for a LEFT perturbation of current_from_previous [1/rad]
  double left_by_slope, right_by_slope;         ///< with respect to the slope, in its standard deviations
};

/// \param ray, tangent of the previous left pixel (x, y, 1) and of the term, rotated into the current left frame
[[gnu::always_inline]] inline DirectionResidual direction_residual(const DirectionTerm& term, const Vector3& ray,
                                                                   const Vector3& tangent) {
  return {dot(term.left_normal, tangent),
          dot(term.right_normal, tangent),
          cross(tangent, term.left_normal),
          cross(tangent, term.right_normal),
          dot(term.left_normal, ray) * term.slope_sigma,
          dot(term.right_normal, ray) * term.slope_sigma};
}

}  // namespace quadedge::pose
