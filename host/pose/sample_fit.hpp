#pragma once
/// \file sample_fit.hpp  Least squares over the few quads of a sample, by their positions and directions.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "pose/direction_residual.hpp"
#include "pose/least_squares.hpp"
#include "pose/reprojection_residual.hpp"

namespace quadedge::pose {

/// All that a quad says about the motion.
struct SampleTerm {
  ReprojectionTerm reprojection;
  DirectionTerm direction;
};

/// \param quad its row in `quads`
SampleTerm make_sample_term(const QuadObservations& quads, std::size_t quad, const NoiseModel& noise);

/// Buffers of the fit, kept between calls so that no step allocates.
struct SampleWorkspace {
  std::vector<double> depth;                                ///< each quad's own unknown (see reprojection_residual())
  std::vector<double> reprojection_error, direction_error;  ///< squared Mahalanobis errors
  std::vector<double> sorted;
};

/// Gauss-Newton with Student-t weights over the quads `rows`, from `current_from_previous`, which it replaces; ends
/// after kFitSteps or with a step below kFitTolerance standard deviations of the pose. The two blocks of
/// residuals (reprojection; direction) have their variances measured anew in each step, by the median. Each quad's true
/// depth and slope are eliminated in closed form, which is the Schur complement of a bundle adjustment of the two rigs.
/// Directions fix the motion of very few quads, whose positions alone hardly do; refine() goes without them.
/// \returns false when the normal equations have no solution (no quads, or all on one spot); the pose is then left at
/// the last good step.
bool fit_sample(const std::vector<SampleTerm>& terms, const std::vector<std::int32_t>& rows, const StereoRig& rig,
                const PoseConfig& config, Eigen::Isometry3d& current_from_previous, SampleWorkspace& workspace);

}  // namespace quadedge::pose
