#pragma once
/// \file sample_fit.hpp  Least squares over the few quads of a sample, using positions and directions.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "motion/least_squares.hpp"
#include "motion/reprojection_terms.hpp"
#include "motion/residuals.hpp"

namespace quadedge::pose {

/// Positions and directions of a quad.
struct SampleTerm {
  ReprojectionTerm reprojection;
  DirectionTerm direction;
};

/// \param quad its row in `quads` \param left the current camera
SampleTerm make_sample_term(const QuadObservations& quads, std::size_t quad, const NoiseModel& noise,
                            const PinholeCamera& left);

/// kLanes terms side by side, so that loops over them vectorise. Lanes without a term are zero and contribute nothing.
struct SampleBlock {
  Lanes<ReprojectionTerm> reprojection;
  Lanes<DirectionTerm> direction;
};

/// Buffers of the fit, kept between calls so that steps allocate nothing.
struct SampleWorkspace {
  std::vector<SampleBlock> blocks;
  std::vector<double> depth;                                ///< depth unknown of each quad, see reprojection_residual()
  std::vector<double> reprojection_error, direction_error;  ///< squared Mahalanobis errors
  std::vector<double> scale_values;
};

/// Gauss-Newton with Student-t weights over the terms `rows`, from `current_from_previous`, which is replaced; ends
/// after kFitSteps steps or with a step below kFitTolerance standard deviations of the pose. The variances of the two
/// blocks of residuals (reprojection; direction) are measured in each step, by the median. The true depth and slope of
/// each quad are eliminated in closed form, which is the Schur complement of a bundle adjustment of the two rigs.
/// Directions determine the motion if there are very few quads, whose positions alone hardly do; refine() does not use
/// them.
/// \returns false if the normal equations have no solution (no quads, or all at the same point); the pose is then that
/// of the last valid step
bool fit_sample(const std::vector<SampleTerm>& terms, const std::vector<std::int32_t>& rows, const PoseConfig& config,
                Eigen::Isometry3d& current_from_previous, SampleWorkspace& workspace);

}  // namespace quadedge::pose
