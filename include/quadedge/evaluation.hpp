#pragma once
/// \file evaluation.hpp  Absolute and relative pose errors of a trajectory. Ground truth enters here and nowhere else.

#include <optional>
#include <string>

#include "quadedge/trajectory.hpp"

namespace quadedge {

/// Statistics of one error.
struct ErrorStatistics {
  double mean = 0, std = 0, rmse = 0, max = 0;  ///< std over N, as evo computes it
};

/// The four errors of the paper's Table 4: rotation in degrees, translation in metres. RPE between consecutive matched
/// poses.
struct PoseErrors {
  ErrorStatistics ape_rotation_deg, ape_translation_m, rpe_rotation_deg, rpe_translation_m;
};

/// Both alignments beside one another.
struct TrajectoryEvaluation {
  PoseErrors origin_aligned;  ///< first matched poses made equal (the paper's choice; `evo --align_origin`)
  PoseErrors se3_aligned;     ///< Umeyama without scale (`evo --align`)
  /// Why the positions leave the rotation of the SE(3) alignment open, whose ape_rotation_deg then is NaN; empty where
  /// they determine it. Positions of a straight or still path do not tell a turn from errors.
  std::string se3_open_rotation;
  int matched = 0;  ///< poses compared
  int estimate_poses = 0, truth_poses = 0;
  double path_length_m = 0;      ///< of the matched truth
  double end_drift_percent = 0;  ///< origin-aligned end point error over the path length
  /// Per matched pose, origin-aligned: stamp, APE rotation [deg], APE translation [m], RPE (NaN for the first).
  struct PerPose {
    std::int64_t stamp_ns;
    double ape_rotation_deg, ape_translation_m, rpe_rotation_deg, rpe_translation_m;
  };
  std::vector<PerPose> per_pose;
};

/// Compares an estimate with the truth. Poses are matched by the nearest stamp within `max_stamp_difference_ns`, each
/// once. `from_frame`: matched poses before this index of the ESTIMATE are left out, and the alignment happens at the
/// first one kept. \throws DataError when fewer than two poses match; says how many of each there are and their stamp
/// ranges.
TrajectoryEvaluation evaluate_trajectory(const Trajectory& estimate, const Trajectory& truth, int from_frame = 0,
                                         std::int64_t max_stamp_difference_ns = 10'000'000);

}  // namespace quadedge
