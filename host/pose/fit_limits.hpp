#pragma once
/// \file fit_limits.hpp  When a Gauss-Newton fit of a pose ends (doc/method.md section 6). Not part of the
/// configuration: a fit that needs more steps starts from a wrong motion, and a smaller step is far below what the
/// noise moves.

namespace quadedge::pose {

/// Most Gauss-Newton steps of one fit.
constexpr int kFitSteps = 5;

/// A step shorter than this ends a fit [standard deviations of the pose].
constexpr double kFitTolerance = 0.01;

}  // namespace quadedge::pose
