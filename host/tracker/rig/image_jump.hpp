#pragma once
/// \file image_jump.hpp  Right images that are displaced along the epipolar lines in single frames: by cameras that
/// swing against one another, or by a line that is read late. doc/method.md section 7.

#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <vector>

#include "common/robust_fit.hpp"
#include "geometry/measured_edges.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::rig {

/// By how much all disparities have grown beyond what a motion of the camera explains, and how certain that is [px].
struct ImageJump {
  double shift = 0, sigma = 0;
  double scatter = 0;  ///< median distance of a disparity from what motion and shift explain

  /// Whether the shift reaches `least` and is neither noise nor an average of different shifts.
  bool is_certain(double least) const;
};

/// When an image counts as displaced.
struct DisplacementLimits {
  double least = std::numeric_limits<double>::infinity();  ///< displacement [px]; infinity: never
  double gain = 1;  ///< ratio of the image's area that is explained with it to that without
};

/// Compares the disparities of matched edges with those that a motion predicts, up to small errors of the motion, which
/// change near points more than distant ones. Robust: objects that move by themselves hardly count.
class JumpMeter {
 public:
  /// \returns nothing for too few matches
  std::optional<ImageJump> measure(const pose::MeasuredEdges& before, const pose::MeasuredEdges& now,
                                   const TemporalMatches& matches, const Eigen::Isometry3d& now_from_before);

 private:
  /// Disparities less the predicted ones [px], by the shift, by a turn of the camera about x and about y, and by a step
  /// along z.
  using Fit = RobustFit<4>;
  std::vector<Fit::Row> rows_;  ///< kept for its memory, as is the fit
  Fit fit_;
};

}  // namespace quadedge::rig
