#pragma once
/// \file synthetic.hpp  The built-in rendered sequences: exact poses, exact depth, nothing to download.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/image.hpp"
#include "quadedge/side.hpp"
#include "quadedge/trajectory.hpp"

namespace quadedge {

/// What to render.
struct SyntheticOptions {
  std::string scene =
      "room";  ///< room: textured walls with objects in front of one another; cables: curved cables before a plain wall
  int frames = 60;
  int width = 942, height = 489;
  double focal = 541.764;       ///< px
  double baseline = 0.0598913;  ///< m
  double noise = 1.5;           ///< standard deviation of the camera noise [grey levels]
  double gain = 1.0;  ///< of the light in every second frame: it changes by this factor, and back, from frame to frame
  double right_gain = 1.0;  ///< of the right camera's exposure
  double blur = 0.0;        ///< motion blur: way of the image's middle, at 2.5 m, while the shutter is open [px]
  double mover = 0.0;       ///< fraction of the left image that a board moving on its own covers
  int supersampling = 4;    ///< rays per pixel and axis
  std::uint64_t seed = 7;   ///< of textures, cable shapes and camera noise; the path and the room's objects stay
  int threads = 0;          ///< that render a view, 0: one per processor; the result does not depend on it
};

/// One rendered view.
struct RenderedView {
  Image image;
  std::vector<float> depth;  ///< height x width, z of the ray through the pixel centre [m]
};

/// A deterministic renderer; what disturbs a camera can be switched on: noise, light, exposure, blur, moving objects.
/// The same options give the same bytes on every run. The world is the first left camera's frame; the rig is rectified.
/// Intensities are linear in reflectance, a pixel is the mean of rays spread over its square (four times as many where
/// a silhouette crosses it).
class SyntheticSequence {
 public:
  /// \throws UsageError that names the option, its value and the allowed range.
  explicit SyntheticSequence(const SyntheticOptions& options);
  ~SyntheticSequence();

  const StereoRig& rig() const;
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
