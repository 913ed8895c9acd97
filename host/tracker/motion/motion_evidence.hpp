#pragma once
/// \file motion_evidence.hpp  Measures what a motion explains of the image, and compares motions.

#include <cstdint>
#include <vector>

#include "common/filter_limits.hpp"
#include "geometry/corrected_rig.hpp"
#include "motion/motion_step.hpp"
#include "quadedge/config.hpp"

namespace quadedge::odometry {

/// The measurements on which the choice between motions rests (motion_selection.hpp).
class MotionEvidence {
 public:
  /// \param rig the calibration
  MotionEvidence(const Config& config, const StereoRig& rig) : config_(config), rig_(corrected_rig(rig, {})) {}

  /// Confirms or refuses the motion of a step whose base's edges were searched for at `predicted` in the left image,
  /// and measures what it explains. A wrong motion also finds some support within the few pixels of the search radius,
  /// but less than the true motion.
  /// \param min_support a motion with less is refused
  void judge(const EdgePositions& predicted, double min_support, MotionStep& step);

  /// Whether most inliers of `found` also agree with the motion `other` since the same frame.
  bool is_same_motion(const MotionStep& found, const Eigen::Isometry3d& other) const;

  /// Explained area of `found` in cells that do not follow the motion of `other`, without edges that the latter
  /// explains closely as well. \param motion that of `other`, since the base of `found`
  double area_beside(const MotionStep& found, const MotionStep& other, const Eigen::Isometry3d& motion) const;

  /// What `other` explains closely of the image while `chosen` is off by more than `distance` [px].
  /// \param chosen current_from_base, since the base of `other`
  ExplainedCells explained_beside(const MotionStep& other, const Eigen::Isometry3d& chosen, double distance) const;

  /// Quads that standstill explains exactly and a motion does not, over all of them; 0 unless they lie on all sides and
  /// most that standstill explains closely are exact, which they are not by chance.
  /// \param still quads near standstill \param motion since their base
  double still_beside(const MotionStep& still, const Eigen::Isometry3d& motion);

  /// Compares a motion since the global matches' base with them: sets global_ratio, agrees_globally and rival_ratio. It
  /// agrees if they follow it in at least as many image cells as an estimate needs inliers: a global match can lie
  /// anywhere, so that a wrong motion agrees with hardly any. Matches in the same cell count once, since their errors
  /// are alike. \param rest what their own motion left of them, with another motion of these; may be null
  void compare_globally(const MotionStep& global_matches, const MotionStep* rest, const Eigen::Isometry3d& motion,
                        Verdict& verdict) const;

  /// Counts the global matches that a motion explains and that of `chosen` does not: sets match_spread, balance
  /// and agrees_globally. \param other, by_chosen motions since the global matches' base
  void compare_globally(const MotionStep& global_matches, const Eigen::Isometry3d& other, const MotionStep& chosen,
                        const Eigen::Isometry3d& by_chosen, OtherPart& part) const;

 private:
  void compare_with_standstill(MotionStep& step);
  double still_near_edges(const MotionStep& step);
  void measure_area(const EdgePositions& predicted, MotionStep& step) const;
  /// Marks the quads within `distance` [px] of where a motion since the step's base brings them.
  int select(const MotionStep& step, const Eigen::Isometry3d& motion, double distance, double angle,
             std::vector<std::uint8_t>& inlier) const;

  Config config_;
  StereoRig rig_;                                 ///< as calibrated, without undistortion tables
  std::vector<std::uint8_t> follows_, is_still_;  ///< kept between calls
};

}  // namespace quadedge::odometry
