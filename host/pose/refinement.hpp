#pragma once
/// \file refinement.hpp  Robust least squares on SE(3) over the places of many quads.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "pose/place_terms.hpp"
#include "pose/scatter.hpp"
#include "pose/scoring.hpp"

namespace quadedge::pose {

/// Buffers of refine(), kept between calls so that steady work allocates nothing.
struct RefinementWorkspace {
  PlaceTerms terms;
  std::vector<std::int32_t> rows, last_rows;  ///< quads selected now and for the last fit
  std::vector<double> sorted;
  double place_scale = 1;  ///< measured variance of the places' errors over the assumed one
  ScatterWorkspace scatter;
};

/// A pose and an offset that all disparities share.
struct OffsetFit {
  Eigen::Isometry3d current_from_previous =
      Eigen::Isometry3d::Identity();  ///< in: the start; out: the pose with the offset
  double offset = 0;  ///< in and out as well; px, added to every right point along its epipolar line, away from the
                      ///< point at infinity
  Eigen::Matrix<double, 7, 7> covariance =
      Eigen::Matrix<double, 7, 7>::Zero();  ///< of (pose, offset), with the prior on the offset
  double offset_variance = 0;               ///< px^2, by the weights alone
};

/// Continues a fit of `workspace.terms` with one more unknown: the offset of all disparities that a rectification
/// leaves, with a prior of variance `variance` [px^2] around zero. Motion along the optical axis scales with depth, and
/// the offset changes the depths of far points more than those of near ones; thousands of edges at all depths tell the
/// two apart, and over a standing camera the prior stays. KITTI 06: the motion comes out 1.2 % too long without it,
/// since disparities are 0.2 px too small. \param scatter what the quads tell counts less against the prior by its
/// weight_factor; the covariance is that of a fit weighed so
///   while the quads' errors scatter by its factor. Weighing by the larger factor would learn the offset more slowly
///   than the data allow (KITTI 01: end drift 1.9 instead of 1.7 %).
/// \returns false, with `result` unchanged, when the equations have no solution.
bool fit_offset(const PoseConfig& config, const Scatter& scatter, double variance, RefinementWorkspace& workspace,
                OffsetFit& result);

/// What refine() leaves.
struct Refined {
  Eigen::Isometry3d current_from_previous = Eigen::Isometry3d::Identity();
  int inliers = 0;
  Matrix6d covariance = Matrix6d::Zero();  ///< see measure_scatter()
  bool solved = false;                     ///< false: no fit was possible, the pose is the initial one, covariance zero
  double offset = 0, offset_variance = 0;  ///< of all disparities, see fit_offset() [px, px^2]
};

/// Alternates between selecting inliers (1.5 px, 10 degrees; both images) and Gauss-Newton with Student-t weights over
/// them, config.refine_rounds times or until the selection hardly changes; of many quads a part settles the selection.
/// A fit ends after config.fit_steps or with a step below config.fit_tolerance standard deviations of the pose; the
/// variance of the errors is measured anew in each step, by the median. Then all inliers go into fit_offset() with a
/// prior of `offset_variance` [px^2], or into one more fit where that is 0.
///
/// Each quad's true depth is eliminated in closed form, which is the Schur complement of a bundle adjustment of the two
/// rigs. Measured on generated quads (f 700 px, base line 0.54 m, 1.2 m forward, 1000 quads, 300 trials), error along
/// the motion:
///   noise 0.15 px, depths 5 to 100 m:   bias  0.00 +- 0.01 mm, scatter 0.23 mm; earlier points taken as exact: 0.03 +-
///   0.02, 0.31 noise 0.30 px, depths 15 to 150 m:  bias -0.03 +- 0.08 mm, scatter 1.33 mm; earlier points taken as
///   exact: 0.67 +- 0.10, 1.70
/// so the scale bias of plain PnP (the motion comes out short) is gone, and a quarter of the scatter with it.
///
/// By the places alone: over many quads directions harm. The slope of a tangent is as uncertain as it is large and
/// shares its errors with the directions it is compared with, and what that bends does not average out. Rendered room,
/// 640 x 332: the root mean square error is 2.1 mdeg by the places alone and 3.4 mdeg with directions. \param inlier
/// one byte per quad, selected at the final pose
Refined refine(const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config,
               const Eigen::Isometry3d& initial, double offset_variance, RefinementWorkspace& workspace,
               std::vector<std::uint8_t>& inlier);

}  // namespace quadedge::pose
