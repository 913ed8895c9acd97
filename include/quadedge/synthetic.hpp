#pragma once
/// \file synthetic.hpp  The built-in rendered sequences: exact poses, exact depth, nothing to download.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "quadedge/calibration.hpp"
#include "quadedge/image.hpp"
#include "quadedge/side.hpp"
#include "quadedge/trajectory.hpp"

namespace quadedge {

/// The built-in scenes. room: textured walls with objects in front of one another; cables: curved cables before a plain
/// wall; facade: a street of houses with siding and brick, a fence and shrubs before them.
const std::vector<std::string>& synthetic_scenes();

/// How the camera can move. ellipse: around 1 m by 0.5 m, seen again every 114 frames, whatever the seed; handheld: in
/// the hand of somebody walking, turning by up to 5 degrees and the image's middle by up to 20 px per frame (at 942
/// px); drive: a car on a lane of 2.8 m (room, 61 frames), 3.1 m (cables, 61) or 26 m (facade, 103); loop: a closed
/// round, the last frame has the first one's pose exactly.
const std::vector<std::string>& synthetic_paths();

/// The lenses that can be rendered: pinhole, and one of typical strength for each LensModel, by its name.
const std::vector<std::string>& synthetic_lenses();

/// What to render.
struct SyntheticOptions {
  std::string scene = "room";    ///< one of synthetic_scenes()
  std::string path = "ellipse";  ///< one of synthetic_paths()
  int frames = 60;
  int width = 942, height = 489;
  double focal = 541.764;        ///< px
  double baseline = 0.0598913;   ///< m
  std::string lens = "pinhole";  ///< one of synthetic_lenses(), of both cameras
  /// The right camera's axes in the left one's, turned by this vector (axis times angle) [degrees].
  Eigen::Vector3d right_rotation = Eigen::Vector3d::Zero();
  double noise = 1.5;  ///< standard deviation of the camera noise [grey levels]
  double gain = 1.0;   ///< of the light in every second frame: it changes by this factor, and back, from frame to frame
  double right_gain = 1.0;  ///< of the right camera's exposure
  double light = 1.0;       ///< of all frames
  double gamma = 1.0;       ///< grey levels become 255 (v / 255)^(1 / gamma), camera noise included
  int bits = 8;             ///< of a pixel: 8, 12 or 16
  double contrast = 1.0;    ///< of the finished picture around grey level 128, camera noise included
  /// Motion blur: way of the image's middle, at 2.5 m, while the shutter is open, on average over the path [px]. The
  /// shutter is open equally long in all frames, a frame period at most: more than the path's mean motion per frame is
  /// refused.
  double blur = 0.0;
  double mover = 0.0;      ///< fraction of the left image that a board moving on its own covers
  int supersampling = 4;   ///< rays per pixel and axis
  std::uint64_t seed = 7;  ///< of textures, camera noise, swaying paths, the shapes of cables and facade
  int threads = 0;         ///< that render a view, 0: one per processor; the result does not depend on it
};

/// One rendered view.
struct RenderedView {
  Image image;
  std::vector<float> depth;  ///< height x width, z of the ray through the centre of the lens's pixel [m]; 0: none
};

/// A deterministic renderer; what disturbs a camera can be switched on: noise, light, exposure, blur, moving objects.
/// The same options give the same bytes on every run. The world is the first left camera's frame; the rig is rectified
/// unless the right camera is turned.
/// Intensities are linear in reflectance, a pixel is the mean of rays spread over its square (four times as many where
/// a silhouette crosses it).
class SyntheticSequence {
 public:
  /// \throws UsageError that names the option, its value and the allowed range.
  explicit SyntheticSequence(const SyntheticOptions& options);
  ~SyntheticSequence();

  /// Scene and path, "facade-drive"; of the ellipse the scene alone.
  std::string name() const;
  const StereoRig& rig() const;                  ///< pinhole cameras; with a lens, tables that make their images
  const StereoCalibration& calibration() const;  ///< the lenses, as told above
  int frames() const;
  std::int64_t stamp_ns(int frame) const;  ///< 20 frames per second
  Eigen::Isometry3d world_from_left(
      int frame) const;  ///< exact, in the middle of the exposure; the first one is the identity
  RenderedView render(int frame, Side side) const;  ///< safe to call from several threads
  double max_disparity() const;                     ///< px, no surface in view is nearer at any time

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace quadedge
