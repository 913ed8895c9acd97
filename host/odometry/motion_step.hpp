#pragma once
/// \file motion_step.hpp  The motion from an earlier rig to the current one: the question and an answer.

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "common/pool.hpp"
#include "frontend/rig.hpp"
#include "pose/motion.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::odometry {

/// What is known of the current frame before its edges are matched with earlier ones.
struct MotionQuery {
  frontend::RigHandle current;
  frontend::RigHandle base;  ///< the rig to start from
  frontend::RigHandle key;   ///< the key rig, preferred where it is in sight; null where the base is the key rig
  Eigen::Isometry3d base_from_key = Eigen::Isometry3d::Identity();  ///< where there is such a key rig
  std::optional<Eigen::Isometry3d> prediction;                      ///< current_from_base by constant velocity
  std::uint64_t seed = 0;
};

/// Of the inlier distance. In fine texture many an edge meets a wrong position by chance, the fewer the nearer it has
/// to come; and of two motions a pixel or two apart only one holds up.
constexpr double kCloseAgreement = 1.0 / 3.0;

/// Quads between an earlier rig and the current one, and the motion they agree on.
struct MotionStep {
  frontend::RigHandle base;  ///< the earlier rig
  TemporalMatches matches;
  pose::QuadObservations quads;
  pose::MotionEstimate motion;
  double support = 0;         ///< inliers, ratio to the base's edges that the motion brings into view
  double explained_area = 0;  ///< the same as a mean over the cells of the image that such edges fall into
  double moving_ratio = 0;    ///< edges in view in cells where few that are found again move like this, of all in view
  bool ambiguous = false;     ///< another motion explains nearly as much of the image

  bool ok() const { return motion.status == pose::MotionStatus::ok; }
  /// Mean over the inliers, in the earlier left camera [1/m]; 0 without inliers.
  double mean_inverse_depth() const {
    double sum = 0;
    for (std::size_t q = 0; q < motion.inlier.size(); ++q)
      if (motion.inlier[q] != 0) sum += static_cast<double>(quads.scoring.inverse_depth[q]);
    return motion.inliers > 0 ? sum / motion.inliers : 0;
  }
  /// Lets go of the rig and keeps the memory.
  void clear() {
    base = nullptr;
    matches.clear();
    motion.status = pose::MotionStatus::too_few_quads;
    support = explained_area = moving_ratio = 0;
    ambiguous = false;
  }
};

/// A step whose arrays serve again.
using StepHandle = Pool<MotionStep>::Handle;

}  // namespace quadedge::odometry
