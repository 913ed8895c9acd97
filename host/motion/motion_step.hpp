#pragma once
/// \file motion_step.hpp  The motion from an earlier rig to the current one: query and result.

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/pool.hpp"
#include "frontend/rig.hpp"
#include "motion/explained_cells.hpp"
#include "motion/motion_selection.hpp"
#include "pose/motion.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::motion {

/// What is known about the current frame before its edges are matched with earlier ones.
struct MotionQuery {
  frontend::RigHandle current;
  frontend::RigHandle base;  ///< the rig that the motion starts from
  frontend::RigHandle key;   ///< the key rig, preferred while in view; null if the base is the key rig
  Eigen::Isometry3d base_from_key = Eigen::Isometry3d::Identity();  ///< valid if `key` is not null
  std::optional<Eigen::Isometry3d> prediction;                      ///< current_from_base by constant velocity
  std::uint64_t seed = 0;
  /// Effort::prediction: only a motion near the prediction, with more support than chance gives; no global matches.
  Effort most = Effort::everything;
};

/// Inliers of two motions, one value per quad; a step keeps them for the next frame, which then allocates nothing.
struct InlierMasks {
  std::vector<std::uint8_t> follows, is_still;
};

/// Quads between an earlier rig and the current one, and the motion that they support.
struct MotionStep {
  frontend::RigHandle base;  ///< the earlier rig
  TemporalMatches matches;
  pose::QuadObservations quads;
  pose::MotionEstimate motion;
  std::vector<std::uint8_t> agrees;  ///< one per quad: whether it agrees closely with the confirmed motion
  InlierMasks masks;
  ExplainedCells cells;  ///< of the confirmed motion
  Verdict verdict;
  Doubt doubt;
  bool is_checked = false;  ///< whether the rest of the image was searched for another motion

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
    agrees.clear();
    cells.clear();
    verdict = {};
    doubt = {};
    is_checked = false;
  }
};

/// A step's motion since `rig`, which, like the step's own rig, is the query's base or key.
inline Eigen::Isometry3d motion_since(const frontend::RigHandle& rig, const MotionQuery& query,
                                      const MotionStep& step) {
  if (step.base == rig) return step.motion.current_from_previous;
  return step.motion.current_from_previous * (rig == query.base ? query.base_from_key.inverse() : query.base_from_key);
}

/// A step from a pool.
using StepHandle = Pool<MotionStep>::Handle;

}  // namespace quadedge::motion
