#pragma once
/// \file paper_search.hpp  The motion as the paper finds it (section 6): quads between adjacent frames, propagated to
/// the key rig through the frames between.

#include "edges/frontend.hpp"
#include "geometry/corrected_rig.hpp"
#include "motion/motion_step.hpp"
#include "motion/refinement.hpp"
#include "quadedge/config.hpp"

namespace quadedge::odometry {

/// Quads with the key rig: those of the key rig and an earlier frame, each continued by all quads of that frame and the
/// current one that start at the edge where it ends. Pairs of edges that are reached twice count once.
TemporalMatches propagate(const TemporalMatches& from_key, const TemporalMatches& from_earlier);

/// No prediction, no confirmation, and no other hypotheses.
class PaperSearch : public MotionFinder {
 public:
  /// Refers to the front end, which must outlive the object. \param rig the calibration
  PaperSearch(const Config& config, frontend::Frontend& frontend, const StereoRig& rig)
      : config_(config.pose), frontend_(frontend), rig_(corrected_rig(rig, {})) {}

  StepHandle find(const MotionQuery& query) override;
  void remember(const MotionStep& found) override;
  double take_pose_ms() override { return std::exchange(pose_ms_, 0); }
  void restart() override { chain_key_ = chain_end_ = -1; }

 private:
  StepHandle new_step(const MotionQuery& query, const frontend::FrameEdgesHandle& base);
  /// The motion of the step's matches, measured at their refined positions.
  void estimate(std::uint64_t seed, MotionStep& step);
  /// Why there is no motion, or the motion.
  Refusal solve(std::uint64_t seed, MotionStep& step);

  PoseConfig config_;
  frontend::Frontend& frontend_;
  StereoRig rig_;  ///< as calibrated, without undistortion tables
  Pool<MotionStep> steps_;
  pose::QuadBuilder quad_builder_;
  pose::RefinementWorkspace refinement_;
  frontend::FrameEdgesHandle current_;   ///< of the last find()
  TemporalMatches chain_;                ///< quads of the key rig and the last frame
  int chain_key_ = -1, chain_end_ = -1;  ///< frame numbers of both
  double pose_ms_ = 0;
};

}  // namespace quadedge::odometry
