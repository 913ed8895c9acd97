#pragma once
/// \file map.hpp  A map of the places of a recording, loops, and the map as a file.

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "quadedge/odometry.hpp"

namespace quadedge {

namespace places {
struct Place;
struct SavedPlaces;
}  // namespace places

/// Keyframes with their poses in the frame of a map, and the cameras that recorded them. Copies share the rigs.
/// Map::saved() makes one, Localiser locates frames in it.
class SavedMap {
 public:
  std::size_t key_rigs() const;
  /// The pinhole cameras of the recording, without undistortion tables.
  const StereoRig& rig() const;
  /// Whether the recorded images had lens distortion: then rig() does not describe further images of these cameras.
  bool is_undistorted() const;
  /// The contents of a map file without its header (doc/method.md section 10).
  std::string bytes() const;
  /// \param source name for messages \throws DataError for anything that bytes() does not write
  static SavedMap from_bytes(std::string_view bytes, const std::string& source);

 private:
  friend class Map;
  friend class Localiser;
  /// \param header everything but the places \param places in the order of the header's poses
  SavedMap(places::SavedPlaces header, std::vector<places::Place> places);
  const places::SavedPlaces& places() const { return *places_; }

  std::shared_ptr<const places::SavedPlaces> places_;
};

/// Writes a map file, completely or not at all. \throws DataError if it cannot be written, or would have more than 2
/// GiB, which read_map() refuses (`map.max_memory_mb` limits it)
void write_map(const std::string& file, const SavedMap& map);

/// \throws DataError that names the file, what was found and what was expected, for a file that is missing, damaged,
/// cut, of another kind, or of another version of the format
SavedMap read_map(const std::string& file);

/// Outcome of the comparison of a frame with a kept keyframe.
enum class ClosureVerdict {
  kept,         ///< the motion is part of the map
  not_found,    ///< no motion between the two was found
  ambiguous,    ///< another motion explains nearly as much of the image
  unconfirmed,  ///< it contradicts the map, or is all that would join two segments, and no second closure agrees with
                ///< it
};
const char* to_string(ClosureVerdict verdict);

/// A frame compared with an earlier keyframe that looks similar or, according to the map, sees the same.
struct Closure {
  int frame = 0;          ///< number of the frame
  int other = 0;          ///< number of the earlier frame
  double similarity = 0;  ///< of their signatures, at most 1; 0 if the map knew that the frame sees this place
  ClosureVerdict verdict = ClosureVerdict::not_found;
  /// Gamma_frame = frame_from_other * Gamma_other, left cameras [m]; empty if no motion was found.
  std::optional<Eigen::Isometry3d> frame_from_other;
  int inliers = 0;     ///< quads that agree with the motion
  double support = 0;  ///< inliers divided by the kept edges that the motion brings into view
  /// Disagreement with the map before, in standard deviations; empty if the two frames belonged to different segments.
  std::optional<double> deviation;
  std::optional<double> distance_m;  ///< the same as a distance [m]
  std::optional<double> angle_deg;   ///< and as an angle
};

/// A map of places beside an odometry, which it never changes: compares keyframes and lost frames with similar
/// earlier ones (doc/method.md section 10), joins segments of the trajectory, and corrects it. Deterministic.
/// Comparisons that take long are made in the frames that follow, so that each takes about as long as without the map.
class Map {
 public:
  /// Refers to the odometry, which must outlive the map and has tracked no frame yet. \throws UsageError if it has, and
  /// if `temporal.global_edges` is 0 or a filter in time uses SIFT, because kept frames have no images.
  explicit Map(StereoOdometry& odometry);
  ~Map();

  /// To be called after every frame with its result. \returns whether the map's poses have changed \throws UsageError
  /// if a frame was left out; DeviceError
  bool add(const FrameResult& result);
  /// Makes the comparisons that still wait, after the last frame. \returns whether the map's poses have changed
  bool finish();

  /// Pose of the odometry's world in the map. Identity until a closure is kept.
  const Eigen::Isometry3d& map_from_odometry() const;
  /// Corrected poses in the map of all frames that are connected with the largest number of others. A frame that the
  /// odometry has lost is among them if its place was recognised.
  Trajectory trajectory() const;
  /// Pose of a frame in this trajectory; empty if it is not among them.
  std::optional<Eigen::Isometry3d> pose(int frame) const;
  /// The kept keyframes of these frames with their corrected poses, copied.
  SavedMap saved() const;
  /// Number of segments: groups of at least two frames that measured motions connect.
  int segments() const;

  const std::vector<Closure>& closures() const;
  std::size_t key_rigs() const;  ///< kept
  std::size_t bytes() const;     ///< of the kept keyframes on the host

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace quadedge
