#pragma once
/// \file residuals.hpp  What least squares over quads minimises, with analytic Jacobians.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>

#include "pose/quads.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge::pose {

/// Standard deviations of what is measured.
struct NoiseModel {
  explicit NoiseModel(const PoseConfig& config);
  double across, along;  ///< of an edge's place across and along itself [px]
  double direction;      ///< of an edge's direction [rad]
  /// Of a place on the epipolar line, for an edge that crosses the line under an angle of sine `epipolar_sine` [px].
  double on_epipolar_line(double epipolar_sine) const;
};

/// One quad, everything divided by its standard deviation beforehand.
///
/// The earlier rig says which point is meant (its left pixel) and how far away it is (inverse depth, noisy); the later
/// rig measures the left pixel, well across the edge and badly along it, and again an inverse depth from its right
/// image. The right image's own information is its place along the epipolar line and nothing else, therefore it enters
/// as inverse depth: using both of its coordinates would count the left image's noise twice. The true inverse depth of
/// the point is an unknown of its own, so both rigs' depths have the same standing and forward and backward errors are
/// weighed alike; see refinement.hpp for what that buys.
struct FitTerm {
  Eigen::Vector3d ray;             ///< of the previous left pixel, previous left frame
  double inverse_depth = 0;        ///< measured before [1/m]
  double inverse_depth_sigma = 0;  ///< [1/m]
  double inverse_depth_per_pixel = 0,
         inverse_depth_bar_per_pixel = 0;  ///< change along the right epipolar lines [1/(m px)]
  Eigen::Vector2d place;                   ///< current left pixel as a ray (x, y, 1)
  Eigen::Vector2d across, along;           ///< unit vectors in the current left image over their sigmas [1/px]
  double inverse_depth_bar = 0;            ///< measured after [1/m]
  double inverse_depth_bar_weight = 0;     ///< 1 / sigma [m]
  Eigen::Vector3d tangent;                 ///< previous, direction + slope * ray, not of unit norm
  double slope_sigma = 0;                  ///< of `slope` in it
  Eigen::Vector3d left_normal,
      right_normal;  ///< current viewing planes of the tangent over the direction's sigma, current left frame
};

/// \param quad its row in `quads`
FitTerm make_term(const QuadObservations& quads, std::size_t quad, const NoiseModel& noise);

/// Residuals of one quad at a pose and a depth, with derivatives by (rotation, translation) of a LEFT perturbation of
/// current_from_previous, exp(w) R and exp(w) T + v to first order, and by the unknowns of the quad itself.
struct Linearisation {
  Eigen::Vector3d place;  ///< across, along, inverse depth after; in standard deviations
  Eigen::Matrix<double, 3, 6> place_by_pose;
  Eigen::Vector3d place_by_offset;  ///< by an offset of both right points along their epipolar lines [1/px]
  Eigen::Vector3d place_by_depth;   ///< by the depth unknown, in standard deviations of the depth before
  Eigen::Vector2d direction;  ///< tangent out of the left and the right viewing plane after; in standard deviations
  Eigen::Matrix<double, 2, 3> direction_by_rotation;
  Eigen::Vector2d direction_by_slope;  ///< by the slope unknown, in standard deviations
};

/// \param depth (true - measured inverse depth before) / sigma, the quad's own unknown; its prior is a standard normal
/// one. \returns false for a point that is not in front of the later left camera.
bool linearise(const FitTerm& term, const PinholeCamera& left, const Eigen::Isometry3d& current_from_previous,
               double depth, Linearisation& result);

}  // namespace quadedge::pose
