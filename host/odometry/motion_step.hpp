#pragma once
/// \file motion_step.hpp  The motion from an earlier rig to the current one: query and result.

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "common/pool.hpp"
#include "frontend/rig.hpp"
#include "pose/motion.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::odometry {

/// What is known about the current frame before its edges are matched with earlier ones.
struct MotionQuery {
  frontend::RigHandle current;
  frontend::RigHandle base;  ///< the rig that the motion starts from
  frontend::RigHandle key;   ///< the key rig, preferred while in view; null if the base is the key rig
  Eigen::Isometry3d base_from_key = Eigen::Isometry3d::Identity();  ///< valid if `key` is not null
  std::optional<Eigen::Isometry3d> prediction;                      ///< current_from_base by constant velocity
  std::uint64_t seed = 0;
};

/// Fraction of the inlier distance that counts as close agreement. In fine texture, edges agree with a wrong position
/// by chance, less often at a smaller distance. Of two motions that differ by a pixel or two, only one agrees closely.
constexpr double kCloseAgreement = 1.0 / 3.0;

/// Quads between an earlier rig and the current one, and the motion that they support.
struct MotionStep {
  frontend::RigHandle base;  ///< the earlier rig
  TemporalMatches matches;
  pose::QuadObservations quads;
  pose::MotionEstimate motion;
  double support = 0;         ///< inliers divided by the base's edges that the motion brings into view
  double explained_area = 0;  ///< the same ratio as a mean over image cells
  double moving_ratio = 0;    ///< fraction of the edges in view in cells that hardly follow the motion
  bool ambiguous = false;     ///< whether another motion explains nearly as much of the image

  bool ok() const { return motion.status == pose::MotionStatus::ok; }
  /// Mean inverse depth of the inliers in the earlier left camera [1/m]; 0 without inliers.
  double mean_inverse_depth() const {
    double sum = 0;
    for (std::size_t q = 0; q < motion.inlier.size(); ++q)
      if (motion.inlier[q] != 0) sum += static_cast<double>(quads.scoring.inverse_depth[q]);
    return motion.inliers > 0 ? sum / motion.inliers : 0;
  }
  /// Releases the rig and keeps the memory.
  void clear() {
    base = nullptr;
    matches.clear();
    motion.status = pose::MotionStatus::too_few_quads;
    support = explained_area = moving_ratio = 0;
    ambiguous = false;
  }
};

/// A step from a pool.
using StepHandle = Pool<MotionStep>::Handle;

}  // namespace quadedge::odometry
