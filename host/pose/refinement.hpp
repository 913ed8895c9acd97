#pragma once
/// \file refinement.hpp  Robust least squares on SE(3) over quads, and the covariance of what it finds.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "pose/residuals.hpp"
#include "pose/scoring.hpp"

namespace quadedge::pose {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Buffers of the fit, kept between calls so that no step allocates.
struct FitWorkspace {
  std::vector<double> depth;                          ///< each quad's own unknown (see linearise())
  std::vector<double> place_error, direction_error;   ///< squared Mahalanobis errors
  std::vector<double> sorted;
  double place_scale = 1, direction_scale = 1;        ///< measured variance over the assumed one, per block of residuals
  bool knows_scales = false;                          ///< from a fit over a part of the same rows: need not be measured before the first step
};

/// Which residuals of a quad take part in a fit. Directions fix the motion of very few quads, whose places alone hardly do. Over
/// many quads they harm: the slope of a tangent is as uncertain as it is large and shares its errors with the directions it is
/// compared with, and what that bends does not average out. Rendered room, 640 x 332: the root mean square error is 2.1 mdeg by the
/// places alone and 3.4 mdeg with directions.
enum class Residuals { places, places_and_directions };

/// Gauss-Newton with Student-t weights over the quads `rows`, from `current_from_previous`, which it replaces; ends after
/// config.fit_steps or with a step below config.fit_tolerance standard deviations of the pose.
/// The two blocks of residuals (place and depth; direction) have their variances measured anew in each step, by the median.
/// Each quad's true depth and slope are eliminated in closed form, which is the Schur complement of a bundle adjustment of the
/// two rigs. Measured on generated quads (f 700 px, base line 0.54 m, 1.2 m forward, 1000 quads, 300 trials), error along the motion:
///   noise 0.15 px, depths 5 to 100 m:   bias  0.00 +- 0.01 mm, scatter 0.23 mm; earlier points taken as exact: 0.03 +- 0.02, 0.31
///   noise 0.30 px, depths 15 to 150 m:  bias -0.03 +- 0.08 mm, scatter 1.33 mm; earlier points taken as exact: 0.67 +- 0.10, 1.70
/// so the scale bias of plain PnP (the motion comes out short) is gone, and a quarter of the scatter with it.
/// \returns false when the normal equations have no solution (fewer than three useful quads, or all on one spot); the pose is then
///   left at the last good step.
bool fit(const std::vector<FitTerm>& terms, const std::vector<std::int32_t>& rows, const StereoRig& rig, const PoseConfig& config,
         Residuals residuals, Eigen::Isometry3d& current_from_previous, FitWorkspace& workspace);

/// How well quads tell a pose.
struct Scatter {
  Matrix6d inverse = Matrix6d::Zero();  ///< of the normal equations: the covariance if errors were independent and as large as assumed
  double factor = 1;                    ///< by how much the errors' scatter is larger
  double weight_factor = 1;             ///< the same for errors alike within the smallest cells only

  Matrix6d covariance() const { return 0.5 * factor * (inverse + inverse.transpose()); }
};

/// Scatter of a pose that fit() or fit_offset() has found by the places of the same rows with the same workspace. Its covariance:
/// (rotation [rad^2], translation [m^2]) of a left perturbation in the current left frame.
///
/// The factor is measured: it says how much more the gradient's contributions scatter than the normal equations expect. Dense edges
/// come in rows of about two per pixel whose errors are alike, and some errors are alike along a whole cable or over a surface. So
/// contributions of quads within one square cell are added up before they are squared: errors that agree within a cell then count
/// once, however many edges tell of them, and independent errors count fully. Cells have sides of config.vote_cell px and two, four,
/// eight and sixteen times that; the largest factor is taken, the one without cells included. The three larger sizes take part as a
/// jackknife, the squared changes of the pose when each cell in turn is left out: plain sums over few cells come out too small, since
/// the fit has adapted to each of them. A size with a cell that holds half of all information tells nothing and is skipped. What is
/// alike over the whole image shows at no size.
/// \param offset of all disparities that was found with the pose [px]
Scatter measure_scatter(const std::vector<FitTerm>& terms, const std::vector<std::int32_t>& rows, const QuadObservations& quads,
                        const StereoRig& rig, const PoseConfig& config, const Eigen::Isometry3d& current_from_previous, double offset,
                        const FitWorkspace& workspace);

/// A pose and an offset that all disparities share.
struct OffsetFit {
  Eigen::Isometry3d current_from_previous = Eigen::Isometry3d::Identity();  ///< in: the start; out: the pose with the offset
  double offset = 0;  ///< in and out as well; px, added to every right point along its epipolar line, away from the point at infinity
  Eigen::Matrix<double, 7, 7> covariance = Eigen::Matrix<double, 7, 7>::Zero();  ///< of (pose, offset), with the prior on the offset
  double offset_variance = 0;  ///< px^2, by the weights alone
};

/// Continues a fit with one more unknown: the offset of all disparities that a rectification leaves, with a prior of variance
/// `variance` [px^2] around zero. Motion along the optical axis scales with depth, and the offset changes the depths of far points
/// more than those of near ones; thousands of edges at all depths tell the two apart, and over a standing camera the prior
/// stays. KITTI 06: the motion comes out 1.2 % too long without it, since disparities are 0.2 px too small.
/// \param scatter what the quads tell counts less against the prior by its weight_factor; the covariance is that of a fit weighed so
///   while the quads' errors scatter by its factor. Weighing by the larger factor would learn the offset more slowly than the data
///   allow (KITTI 01: end drift 1.9 instead of 1.7 %).
/// \returns false, with `result` unchanged, when the equations have no solution.
bool fit_offset(const std::vector<FitTerm>& terms, const std::vector<std::int32_t>& rows, const StereoRig& rig, const PoseConfig& config,
                const Scatter& scatter, double variance, FitWorkspace& workspace, OffsetFit& result);

/// What refine() leaves.
struct Refined {
  Eigen::Isometry3d current_from_previous = Eigen::Isometry3d::Identity();
  std::vector<std::uint8_t> inlier;   ///< one byte per quad, selected at the final pose
  int inliers = 0;
  Matrix6d covariance = Matrix6d::Zero();  ///< see measure_scatter()
  bool solved = false;                ///< false: no fit was possible, the pose is the initial one, covariance zero
  double offset = 0, offset_variance = 0;  ///< of all disparities, see fit_offset() [px, px^2]
};

/// Alternates between selecting inliers (1.5 px, 10 degrees; both images) and fit(), config.refine_rounds times or until the selection
/// hardly changes; of many quads a part settles the selection. Then all of them go into fit_offset() with a prior of
/// `offset_variance` [px^2], or into one more fit() where that is 0. By the places alone, see Residuals.
Refined refine(const std::vector<FitTerm>& terms, const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config,
               const Eigen::Isometry3d& initial, double offset_variance = 0);

/// Indices of the non-zero bytes, ascending.
void mask_to_rows(const std::vector<std::uint8_t>& mask, std::vector<std::int32_t>& rows);

/// exp(rotation) and translation applied from the left.
Eigen::Isometry3d perturb(const Vector6d& step, const Eigen::Isometry3d& current_from_previous);

}  // namespace quadedge::pose
