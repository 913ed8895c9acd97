#pragma once
/// \file result_rows.hpp  The CSV files of results (doc/reference.md), row by row. Fields without a value are empty.

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "quadedge/edges.hpp"
#include "quadedge/evaluation.hpp"
#include "quadedge/localiser.hpp"
#include "quadedge/map.hpp"
#include "quadedge/match_stereo.hpp"
#include "quadedge/odometry.hpp"

namespace quadedge::report {

/// Truncates the file on opening and flushes after each append, so that a run that dies keeps all finished rows.
class AppendFile {
 public:
  /// \throws DataError with path and reason when the file cannot be opened.
  explicit AppendFile(std::string path);

  /// \throws DataError with path and reason (full disk) when the text cannot be written.
  void append(const std::string& text);

 private:
  [[noreturn]] void fail(const char* what) const;
  std::string path_;
  std::ofstream stream_;
};

/// The files of a run that get a row with every frame: trajectory.txt, trajectory_kitti.txt; frames.csv with status,
/// counts and times; and poses.csv: frame, stamp_s, status, segment, reference_frame; the left camera's pose in the
/// world (x, y, z [m], qx, qy, qz, qw) and in the frame of the reference's left camera (reference_x ... reference_qw);
/// then the upper triangles of both covariances, row by row (covariance_x_x, covariance_x_y ... covariance_rz_rz and
/// reference_covariance_...), in the order x, y, z, rotation about x, y, z of the frame that the pose is in; see
/// PoseCovariance; and base_frame, as in FrameDiagnostics. A lost frame has the predicted pose in the world and nothing
/// else.
class GrowingFiles {
 public:
  /// Truncates them. \throws DataError with path and reason, as does add().
  explicit GrowingFiles(const std::string& folder);
  void add(const FrameResult& result);

 private:
  int segment_ = 0, number_ = 0;
  AppendFile tum_, kitti_, frames_, poses_;
};

/// The files of a localisation that get a row with every frame: trajectory.txt with those that are located, and
/// locations.csv: frame, stamp_s, status, key_rig, followed, inliers, support; x, y, z [m] and qx, qy, qz, qw of the
/// left camera in the map; latency_ms, warning, message.
class LocationFiles {
 public:
  /// Truncates them. \throws DataError with path and reason, as does add().
  explicit LocationFiles(const std::string& folder);
  void add(int number, const Localisation& frame);

 private:
  AppendFile trajectory_, rows_;
};

/// errors.csv: stamp_s, ape_rotation_deg, ape_translation_m, rpe_rotation_deg, rpe_translation_m of every pose that has
/// ground truth; origin-aligned. The first pose of a segment has no step before it: its RPE fields are empty.
std::string errors_csv(const TrajectoryEvaluation& evaluation);

/// loops.csv, the comparisons of frames with earlier keyframes: frame, other, verdict, similarity, inliers,
/// support; x, y, z [m] and qx, qy, qz, qw of the frame's left camera in that of the other frame, empty without a
/// motion; deviation, distance_m and angle_deg from the map before, empty for frames of different segments.
std::string loops_csv(const std::vector<Closure>& closures);

/// Edges of an image: `x,y,direction_rad,strength`, 6 decimals; pixels, radians, grey levels per pixel.
std::string edges_csv(const EdgeSet& edges);

/// Stereo edges of a pair: `left_x,left_y,left_direction_rad,right_x,right_y,right_direction_rad,ncc,x_m,y_m,z_m`, 6
/// decimals: pixels and radians, the similarity of the pair (-1 to 1), the point in the left camera's frame. The last
/// three are empty for an edge without a point, and for all edges without `depths`.
std::string matches_csv(const StereoMatches& matches, bool depths);

}  // namespace quadedge::report
