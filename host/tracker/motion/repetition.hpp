#pragma once
/// \file repetition.hpp  Scenes that repeat along the motion: a motion that is off by a period explains the same edges.

#include <Eigen/Geometry>

#include "geometry/measured_edges.hpp"
#include "motion/motion_step.hpp"
#include "quadedge/camera.hpp"

namespace quadedge::odometry {

/// Shift along the translation of a step's motion at which many of the edges that it explains have equals, at the same
/// depth and with the same direction; of several the smallest [m, of either sign]. 0 if the scene does not repeat, or
/// if the camera hardly moves. \param camera, measured the current left camera and frame
double period_along(const PinholeCamera& camera, const pose::MeasuredEdges& measured, const MotionStep& step);

/// Whether another motion since the step's base differs by a whole number of periods along the translation.
bool differs_by_periods(const MotionStep& step, const Eigen::Isometry3d& other, double period);

/// Matches with the current edges, around what a motion since the base predicts.
struct MatchedMotion {
  const TemporalMatches& matches;
  const Eigen::Isometry3d& current_from_base;
};

/// The current edges that two motions find again, among those that tell where along the motion the camera is and hardly
/// change their size by either: that of a smaller motion finds more, which decides nothing.
struct SharedEdges {
  double both = 0;
  double first = 0, second = 0;  ///< only this one, although the other had them in view

  /// Whether edges that are not repeated show that the first motion, or the second one, is the camera's.
  bool tell_for_first() const { return tell_for(first, second); }
  bool tell_for_second() const { return tell_for(second, first); }

 private:
  bool tell_for(double one, double other) const;
};

/// Compares motions that differ by a shift.
SharedEdges compare_shifted(const PinholeCamera& camera, const pose::MeasuredEdges& measured,
                            const MatchedMotion& first, const MatchedMotion& second);

}  // namespace quadedge::odometry
