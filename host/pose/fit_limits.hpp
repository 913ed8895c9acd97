#pragma once
/// \file fit_limits.hpp  Termination of Gauss-Newton fits of a pose (doc/method.md section 6). Not configurable: a fit
/// that needs more steps started from a wrong motion, and smaller steps are far below the effect of noise.

namespace quadedge::pose {

/// Maximum number of Gauss-Newton steps of a fit.
constexpr int kFitSteps = 5;

/// Step length below which a fit ends [standard deviations of the pose].
constexpr double kFitTolerance = 0.01;

}  // namespace quadedge::pose
