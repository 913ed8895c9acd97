#pragma once
/// \file point_cloud.hpp  The edges of a recording in space, extended with every keyframe.

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "quadedge/odometry.hpp"

namespace quadedge {

/// A point on an edge in space.
struct CloudPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3f tangent = Eigen::Vector3f::UnitX();  ///< its sign encodes contrast as in EdgeSet::direction
  float grey = 0;                                      ///< grey level of the image at the edge, 0 to 255
  /// Standard deviation of the position in its least certain direction, usually the depth, due to edge noise alone;
  /// errors of the camera poses add to it [m].
  float sigma = 0;
  int views = 1;  ///< number of keyframes that observed it
};

/// Limits of a point cloud.
struct PointCloudOptions {
  int min_views = 3;                    ///< points() omits points observed by fewer keyframes
  std::size_t most_points = 2'000'000;  ///< maximum number in memory, at 80 bytes each
};

/// A keyframe that points were made from.
struct CloudView {
  int frame = 0;  ///< number of the frame
  std::int64_t stamp_ns = 0;
  Eigen::Isometry3d world_from_left = Eigen::Isometry3d::Identity();
};

/// Stereo edges of keyframes. Edges of a later rig are merged with the existing point whose projection lies on an
/// edge of the same direction and depth (doc/method.md section 9). Memory is bounded: points with few observations are
/// discarded first.
class PointCloud {
 public:
  /// \param config StereoOdometry::config()
  explicit PointCloud(const Config& config, const PointCloudOptions& options = {});
  ~PointCloud();

  /// To be called for every frame after it was tracked. Adds the frame's edges if the frame became the keyframe
  /// and its motion is not ambiguous. \returns whether they were added
  bool add(const StereoFrame& frame, const FrameResult& result, const StereoOdometry& odometry);

  /// Moves the view of every frame to `world_from_left(frame)`, and each point with the view that observed it last.
  /// Views of frames without such a pose stay. To be called after all frames: later ones are not merged with moved
  /// points.
  void correct(const std::function<std::optional<Eigen::Isometry3d>(int)>& world_from_left);

  /// Points observed by enough keyframes, in the world frame (the first left camera), oldest first.
  std::vector<CloudPoint> points() const;
  const std::vector<CloudView>& views() const;
  /// Number of points with enough observations that were discarded because memory was full.
  std::size_t dropped() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Writes points as a binary PLY file with the properties x y z [m], tangent_x tangent_y tangent_z, grey, sigma [m],
/// views, and red, green, blue, which repeat the grey value for viewers. The file is written completely or not at all.
/// \throws DataError if it cannot be written.
void write_ply(const std::string& file, const std::vector<CloudPoint>& points);

}  // namespace quadedge
