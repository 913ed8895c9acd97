#pragma once
/// \file refinement.hpp  Robust least squares on SE(3) over the positions of many quads, and over the pose and a common
/// offset of all disparities (doc/method.md section 6).

#include <cstdint>
#include <optional>
#include <vector>

#include "motion/covariance.hpp"
#include "motion/motion_estimate.hpp"
#include "motion/reprojection_terms.hpp"
#include "motion/scoring.hpp"
#include "quadedge/config.hpp"

namespace quadedge::pose {

/// Continues a fit of `terms` with one more unknown: the common offset of all disparities left by rectification, with a
/// zero-mean prior [px]. Edges at all depths separate it from a motion along the optical axis;
/// a stationary camera leaves the prior unchanged.
/// \param covariance the information of the quads is reduced by small_cell_inflation relative to the prior; the
/// covariance of the result is that of a fit with these weights, with errors that scatter by `inflation`
/// \param reprojection_scale ratio of measured to assumed variance of the reprojection residuals
/// \param focal_length of the left camera [px]
/// \param free in: initial pose and offset; out: the solution of the equations, without its uncertainties
/// \returns what is worth learning from it, see MotionEstimate::learned; nothing if the equations have no solution
std::optional<PoseAndOffset> fit_offset(const PoseConfig& config, const MeasuredCovariance& covariance,
                                        const OffsetPrior& prior, double reprojection_scale, double focal_length,
                                        ReprojectionTerms& terms, PoseAndOffset& free);

/// Buffers of refine(), kept between calls so that steady-state operation allocates nothing.
struct RefinementWorkspace {
  ReprojectionTerms terms;
  std::vector<std::int32_t> rows, last_rows;  ///< quads selected for the current and the last fit
  std::vector<std::int32_t> changed_rows;     ///< those selected for only one of them
  std::vector<double> scale_values;
  double reprojection_scale = 1;  ///< ratio of measured to assumed variance of the reprojection residuals
  CovarianceWorkspace covariance;
};

/// Result wanted from refine(): the pose alone suffices for a motion that a guided search will measure.
enum class RefinementGoal { pose, pose_and_covariance };

/// Alternates between selecting inliers and Gauss-Newton with Student-t weights over their positions, until the
/// selection hardly changes; the variance of the errors is measured in each step. All inliers are then used in
/// fit_offset() with the prior `offset`, or in one more fit if its variance is 0. With RefinementGoal::pose,
/// neither offset nor covariance is computed. The true depth of each quad is eliminated in closed form, which is the
/// Schur complement of a bundle adjustment of the two rigs and removes the scale bias of plain PnP. Directions are not
/// used: the errors of slopes are correlated with the directions that they are compared with.
/// \param motion in: the initial pose; out: pose, offset, what is learned, and the inliers at the pose
/// \returns false if the last fit had no solution; the pose is that before it and the covariance zero
bool refine(const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config, const OffsetPrior& offset,
            RefinementWorkspace& workspace, MotionEstimate& motion,
            RefinementGoal goal = RefinementGoal::pose_and_covariance);

}  // namespace quadedge::pose
