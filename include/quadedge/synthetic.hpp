#pragma once
/// \file synthetic.hpp  Built-in rendered sequences with exact poses and depths; nothing has to be downloaded.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "quadedge/calibration.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/image.hpp"

namespace quadedge {

/// Built-in scenes. room: textured walls with objects that occlude each other; cables: curved ones before a plain wall;
/// facade: houses with siding and brick, behind a fence; yard: a plain wall, a railing, wires.
const std::vector<std::string>& synthetic_scenes();

/// Camera paths. ellipse: 1 m by 0.5 m, repeated every 114 frames for any seed; handheld: a walking person's
/// camera, which turns by up to 5 degrees and moves the middle of the image by up to 20 px per frame (at 942 px);
/// drive: a car on a lane of 2.8 m (room, 61 frames), 3.1 m (cables, 61), or 26 m (facade, yard: 103);
/// loop: a closed loop whose last frame has exactly the first pose.
const std::vector<std::string>& synthetic_paths();

/// Lenses that can be rendered: pinhole, and one of typical strength for each LensModel, by its name.
const std::vector<std::string>& synthetic_lenses();

/// Rigs that can be rendered. rectified: two equal cameras; eth3d-slam: the stereo cameras of the recording cables_2 of
/// ETH3D's SLAM benchmark, pinholes of different size and principal point that are not rectified. Its left camera is
/// camera 2 of that benchmark.
const std::vector<std::string>& synthetic_rigs();

/// Rendering options.
struct SyntheticOptions {
  std::string scene = "room";    ///< one of synthetic_scenes()
  std::string path = "ellipse";  ///< one of synthetic_paths()
  int frames = 60;
  std::string rig = "rectified";  ///< one of synthetic_rigs(); another than rectified states the next six itself
  int width = 942, height = 489;
  double focal = 541.764;        ///< px
  double baseline = 0.0598913;   ///< m
  std::string lens = "pinhole";  ///< one of synthetic_lenses(), for both cameras
  /// Rotation of the right camera's axes relative to the left camera's, as a rotation vector [degrees].
  Eigen::Vector3d right_rotation = Eigen::Vector3d::Zero();
  double noise = 1.5;  ///< standard deviation of the camera noise [grey levels]
  double gain = 1.0;   ///< change of the light in every second frame, as a factor; it alternates from frame to frame
  double right_gain = 1.0;  ///< exposure of the right camera, as a factor
  double light = 1.0;       ///< brightness of all frames, as a factor
  double gamma = 1.0;       ///< grey levels become 255 (v / 255)^(1 / gamma), including camera noise
  int bits = 8;             ///< bits per pixel: 8, 12 or 16
  double contrast = 1.0;    ///< contrast of the finished image about grey level 128, including camera noise
  /// Motion blur: mean displacement of the middle of the image, at 2.5 m, during the exposure [px]. The exposure time
  /// is the same in all frames and at most a frame period: values above the path's mean motion per frame are rejected.
  double blur = 0.0;
  double mover = 0.0;      ///< fraction of the left image covered by an independently moving board
  int supersampling = 4;   ///< rays per pixel and axis
  std::uint64_t seed = 7;  ///< of textures, camera noise, hand shake, and the shapes of cables and facade
  int threads = 0;         ///< threads that render a view, 0: one per processor; results do not depend on it
};

/// One rendered view.
struct RenderedView {
  Image image;
  std::vector<float> depth;  ///< height x width, z along the ray through the lens's pixel [m]; 0: none
};

/// A deterministic renderer with optional disturbances: noise, light, exposure, blur, moving objects. Identical options
/// give identical bytes. The world frame is the first left camera; the rig is rectified unless the right camera is
/// rotated. Intensities are linear in reflectance. A pixel is the mean of rays spread over its area (four times as many
/// where a silhouette crosses it).
class SyntheticSequence {
 public:
  /// \throws UsageError that names the option, its value and the allowed range.
  explicit SyntheticSequence(const SyntheticOptions& options);
  ~SyntheticSequence();

  /// Scene and path, such as "facade-drive"; for the ellipse the scene alone.
  std::string name() const;
  /// Pinhole cameras; for other lenses with undistortion tables. No surface exceeds its max_disparity in any frame.
  const StereoRig& rig() const;
  const StereoCalibration& calibration() const;  ///< the rendered lenses
  int frames() const;
  std::int64_t stamp_ns(int frame) const;  ///< 20 frames per second
  Eigen::Isometry3d world_from_left(
      int frame) const;  ///< exact, at the middle of the exposure; identity for the first frame
  RenderedView render(int frame, Side side) const;  ///< thread-safe
  StereoPair pair(int frame) const;                 ///< both images of a frame
  const SyntheticOptions& options() const;          ///< with the numbers of the rig

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace quadedge
