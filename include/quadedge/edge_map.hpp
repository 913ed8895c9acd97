#pragma once
/// \file edge_map.hpp  The edges of a recording in space: a map that grows with every key stereo rig.

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/image.hpp"
#include "quadedge/odometry.hpp"

namespace quadedge {

/// A piece of an edge in space.
struct MapPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3f tangent = Eigen::Vector3f::UnitX();  ///< unit norm; its sign carries contrast as EdgeSet::direction
  float grey = 0;                                      ///< grey level of the image at the edge, 0 to 255
  /// Standard deviation of the position in the direction that is known least, mostly the depth, by the noise of the
  /// edges alone: errors of the cameras' poses come on top [m].
  float sigma = 0;
  int views = 1;  ///< key stereo rigs that saw it
};

/// What a map keeps.
struct EdgeMapOptions {
  int min_views = 3;                    ///< points seen by fewer key stereo rigs are not told
  std::size_t most_points = 2'000'000;  ///< kept at once, 80 bytes each; 230 with tracks
  bool tracks = false;                  ///< keep where each point was seen, for write_colmap()
};

/// A key stereo rig of a map.
struct MapView {
  int frame = 0;  ///< number of the frame
  std::int64_t stamp_ns = 0;
  Eigen::Isometry3d world_from_left = Eigen::Isometry3d::Identity();
};

/// Where a point was seen: in the left image of a view, by its number. On the tangent of the edge that was seen, at the
/// place nearest to the point, since along its curve an edge lies anywhere.
struct MapSighting {
  std::int32_t view = 0;
  float x = 0, y = 0;  ///< [px]
};

/// Stereo edges of key stereo rigs, merged where a later one sees an earlier one's edge again: where the projected
/// point comes to lie on an edge of the same direction and depth (doc/method.md section 9). Memory is bounded: points
/// that few have seen give way first.
class EdgeMap {
 public:
  EdgeMap(const Config& config, const EdgeMapOptions& options);
  ~EdgeMap();

  /// To be called for every frame, after it was tracked. Takes it in, with its result, if it has become the key stereo
  /// rig and its motion is not doubtful. \returns whether it was taken in
  bool add(const StereoFrame& frame, const FrameResult& result, const StereoOdometry& odometry);

  /// Points that enough key stereo rigs have seen, in the world (the first left camera's frame), oldest first.
  std::vector<MapPoint> points() const;
  /// Where these points were seen, one list per point, at most eight in each; empty without EdgeMapOptions::tracks.
  std::vector<std::vector<MapSighting>> sightings() const;
  const std::vector<MapView>& views() const;
  /// Points that gave way since the memory was full, of those that enough key stereo rigs had seen.
  std::size_t dropped() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Writes points as a binary PLY file: x y z [m], tangent_x tangent_y tangent_z, grey, sigma [m], views, and red,
/// green, blue, which are the grey value for viewers. Complete or not at all. \throws DataError when it cannot be
/// written.
void write_ply(const std::string& file, const std::vector<MapPoint>& points);

/// Writes cameras.txt, images.txt and points3D.txt as COLMAP reads them: camera 1 is the left pinhole camera, 2 the
/// right one; every view has two images, left_FRAME.png and right_FRAME.png with six digits, and points in the left
/// one. The folder is made. \throws DataError when something cannot be written.
void write_colmap(const std::string& folder, const StereoRig& rig, const EdgeMap& map);

}  // namespace quadedge
