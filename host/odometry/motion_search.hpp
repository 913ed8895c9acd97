#pragma once
/// \file motion_search.hpp  From the current stereo edges to the motion since an earlier rig: where to look, and what
/// to believe.

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/pool.hpp"
#include "frontend/frontend.hpp"
#include "odometry/disparity_offset.hpp"
#include "pose/motion.hpp"
#include "quadedge/config.hpp"

namespace quadedge::odometry {

/// Which rig the current one is matched with.
enum class Base { previous, key };

/// Quads between a base and the current frame, and the motion they agree on.
struct MotionStep {
  Base base = Base::previous;
  TemporalMatches matches;
  pose::QuadObservations quads;
  pose::MotionEstimate motion;
  double support = 0;  ///< inliers, share of the base's edges that the motion brings into view
  double area = 0;     ///< the same as a mean over the cells of the image that such edges fall into

  bool ok() const { return motion.status == pose::MotionStatus::ok; }
};
/// A step whose arrays serve again.
using StepHandle = Pool<MotionStep>::Handle;

/// What is known of the current frame's motion before its edges are matched with earlier ones.
struct MotionPrior {
  const frontend::Rig& rig(Base which) const { return which == Base::key ? *key : *previous; }

  frontend::RigHandle current;
  Base base = Base::previous;                                  ///< the rig to start from
  std::optional<Eigen::Isometry3d> prediction = std::nullopt;  ///< current_from_base by constant velocity
  std::optional<Eigen::Isometry3d> base_from_key =
      std::nullopt;  ///< the key rig beyond the base, preferred where it is in sight
  frontend::RigHandle key, previous;
  std::uint64_t seed = 0;
};

/// A scout finds the motion since the base, near the prediction or else anywhere; it guides the matching of all edges
/// with the key rig or, where that one is out of sight, with the base. That matching has to convince: by its support,
/// or by edges found anywhere.
class MotionSearch {
 public:
  /// Refers to the frontend and to the offset, which must outlive it.
  MotionSearch(const StereoRig& rig, const Config& config, frontend::Frontend& frontend, const DisparityOffset& offset)
      : rig_(rig), config_(config), frontend_(frontend), offset_(offset) {}

  /// The motion of the frontend's current rig; its status says whether there is one. The search must outlive the
  /// handle.
  StepHandle find(const MotionPrior& prior);

 private:
  const pose::MeasuredEdges& measured(Base base, const MotionPrior& prior);

  StepHandle new_step(Base base);
  StepHandle scout(const MotionPrior& prior, double radius);
  StepHandle look_anywhere(const MotionPrior& prior);
  StepHandle look_beside(const MotionStep& seen, const MotionPrior& prior);
  void suggest_anywhere(const MotionPrior& prior, MotionStep& step);
  double explained_area(const MotionStep& step, const PlacedEdges& predicted);
  StepHandle scout_and_confirm(const MotionPrior& prior, double radius);
  StepHandle confirm(const Eigen::Isometry3d& motion, const MotionPrior& prior);
  bool is_seen(const MotionStep& anywhere, const MotionStep& found, const MotionPrior& prior);
  StepHandle match(Base base, Eigen::Isometry3d motion, const MotionPrior& prior);
  void estimate(const std::optional<Eigen::Isometry3d>& prediction, const PoseConfig& limits, const MotionPrior& prior,
                MotionStep& step);

  StereoRig rig_;
  Config config_;
  frontend::Frontend& frontend_;
  const DisparityOffset& offset_;

  // Buffers that are kept from frame to frame.
  Pool<MotionStep> steps_;
  TemporalSearch search_, settled_;
  pose::QuadBuilder builder_;
  pose::MotionEstimator estimator_;
  std::vector<std::uint8_t> agrees_;
  struct Cell {
    double edges = 0, explained = 0;
  };
  std::vector<Cell> cells_;
};

}  // namespace quadedge::odometry
