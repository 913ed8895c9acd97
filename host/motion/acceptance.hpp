#pragma once
/// \file acceptance.hpp  Measures what a confirmed motion explains, and compares motions.

#include <vector>

#include "common/temporal_search.hpp"
#include "motion/disparity_offset.hpp"
#include "motion/motion_step.hpp"
#include "quadedge/config.hpp"

namespace quadedge::motion {

/// The measurements on which the choice between motions rests (motion_selection.hpp).
class Acceptance {
 public:
  /// Refers to `offset`, which must outlive the object.
  Acceptance(const Config& config, const DisparityOffset& offset) : config_(config), offset_(offset) {}

  /// Sets the support of `step`. Below temporal.min_support its status becomes no_consensus: within the search radius a
  /// few pixels wide, a wrong motion also finds some support, but less than the true motion.
  /// \param predicted positions at which the base's edges were searched for in the left image
  void test_support(const EdgePositions& predicted, MotionStep& step) const;

  /// Sets the rest of the verdict, except for the agreement with global matches, and which quads agree closely or are
  /// still.
  void judge(const EdgePositions& predicted, MotionStep& step) const;

  /// Whether most inliers of `found` also agree with the motion `other` since the same rig.
  bool is_same_motion(const MotionStep& found, const Eigen::Isometry3d& other) const;

  /// Explained area of `found` in cells that do not follow the motion of `other`, without edges that the latter
  /// explains closely as well. \param motion that of `other`, since the rig of `found`
  double area_beside(const MotionStep& found, const MotionStep& other, const Eigen::Isometry3d& motion) const;

  /// What `other` explains closely of the image while `chosen` is off by more than `distance` [px].
  /// \param chosen current_from_base, since the base of `other`
  ExplainedCells explained_beside(const MotionStep& other, const Eigen::Isometry3d& chosen, double distance) const;

  /// Whether global matches agree with a motion in at least as many image cells as an estimate needs inliers. A global
  /// match can lie anywhere in the image, so that a wrong motion agrees with hardly any of them. Matches in the same
  /// cell count once, because the errors of neighbours are correlated.
  /// \param ratio is set to the fraction of the global matches that agree
  bool agrees_with_global_matches(const MotionStep& global_matches, const MotionQuery& query, const MotionStep& step,
                                  double& ratio) const;

 private:
  /// Fraction of the quads that are static although the motion would have moved them. Edges are not static by chance,
  /// and distant edges agree with the motion as well. Hence, either the camera did not move, or something moves along
  /// with it.
  double static_ratio(const MotionStep& step, InlierMasks& masks) const;

  /// Sets the explained area, which weights objects by the area that they cover, not by their number of edges, and the
  /// moving ratio.
  void measure_area(const EdgePositions& predicted, MotionStep& step) const;

  Config config_;
  const DisparityOffset& offset_;
};

}  // namespace quadedge::motion
