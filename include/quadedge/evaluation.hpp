#pragma once
/// \file evaluation.hpp  Absolute and relative pose errors of a trajectory. Ground truth is used here only.

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "quadedge/trajectory.hpp"

namespace quadedge {

/// Statistics of one kind of error.
struct ErrorStatistics {
  double mean = 0, std = 0, rmse = 0, max = 0;  ///< std divides by N, as in evo
};

/// The four errors of the paper's Table 4: rotation in degrees, translation in metres. RPE is computed between
/// consecutive matched poses of one segment. Errors without a value are NaN.
struct PoseErrors {
  ErrorStatistics ape_rotation_deg, ape_translation_m, rpe_rotation_deg, rpe_translation_m;
};

/// Relative errors over sub-paths of one length, or of all lengths, as KITTI's odometry benchmark defines t_rel and
/// r_rel: a sub-path starts at every tenth matched pose and ends at the first one that is farther away along the true
/// path, within a segment; the errors of its end, seen from its start, are divided by the length.
struct SubPathErrors {
  double length_m = std::numeric_limits<double>::quiet_NaN();                ///< NaN: of all lengths
  int count = 0;                                                             ///< number of sub-paths
  double translation_percent = std::numeric_limits<double>::quiet_NaN();     ///< mean t_rel; NaN without sub-paths
  double rotation_deg_per_m = std::numeric_limits<double>::quiet_NaN();      ///< mean r_rel; NaN without sub-paths
  double translation_sd_percent = std::numeric_limits<double>::quiet_NaN();  ///< over sub-paths of one length, as next
  double rotation_sd_deg_per_m = std::numeric_limits<double>::quiet_NaN();
};

/// Lengths of the sub-paths of KITTI's odometry benchmark [m].
inline const std::vector<double> kKittiLengths = {100, 200, 300, 400, 500, 600, 700, 800};

/// Errors after each of the two alignments.
struct TrajectoryEvaluation {
  PoseErrors origin_aligned;  ///< first matched poses made identical (the paper's choice; `evo --align_origin`)
  PoseErrors se3_aligned;     ///< Umeyama without scale (`evo --align`)
  /// Why the positions do not determine the rotation of the SE(3) alignment, whose ape_rotation_deg is then NaN; empty
  /// if they do. Those of a straight or stationary path do not distinguish a rotation from errors.
  std::string se3_open_rotation;
  int matched = 0;    ///< number of poses compared
  int rpe_steps = 0;  ///< number of steps that RPE covers
  /// Median duration of these steps, which are one frame where no pose is missing [s]; NaN without steps.
  double rpe_interval_s = std::numeric_limits<double>::quiet_NaN();
  std::vector<SubPathErrors> sub_paths;  ///< one per length
  SubPathErrors sub_path_mean;           ///< over the sub-paths of all lengths
  int estimate_poses = 0, truth_poses = 0;
  double path_length_m = 0;  ///< of the matched ground truth
  /// End-point error after origin alignment, relative to the path length; NaN where the ground truth does not move.
  double end_drift_percent = std::numeric_limits<double>::quiet_NaN();
  /// Per matched pose, origin-aligned: timestamp, APE rotation [deg], APE translation [m], RPE (NaN for the first
  /// pose of a segment).
  struct PerPose {
    std::int64_t stamp_ns;
    double ape_rotation_deg, ape_translation_m, rpe_rotation_deg, rpe_translation_m;
  };
  std::vector<PerPose> per_pose;
  int segment = 0;  ///< number of the first pose's segment
  /// Of several segments, every one by itself, with its own alignments; errors of a single pose are NaN.
  std::vector<TrajectoryEvaluation> segments;
};

/// Compares an estimated trajectory with ground truth. Poses are matched by nearest timestamp within
/// `max_stamp_difference_ns`, each at most once. `from_frame`: matched poses before this index of the ESTIMATE are
/// ignored, and the origin alignment uses the first remaining pose. The errors of the whole include the unknown motions
/// between segments, except for RPE, which is not computed across them. \throws DataError if fewer than two poses
/// match; the message states the number of poses and the range of timestamps of both trajectories. `lengths`: of the
/// sub-paths [m]; UsageError if one is not positive.
TrajectoryEvaluation evaluate_trajectory(const Trajectory& estimate, const Trajectory& truth, int from_frame = 0,
                                         std::int64_t max_stamp_difference_ns = kStampToleranceNs,
                                         const std::vector<double>& lengths = kKittiLengths);

}  // namespace quadedge
