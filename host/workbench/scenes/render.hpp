#pragma once
/// \file render.hpp  Renders one view by ray casting, exposed for a time, with a board that moves.

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "quadedge/camera.hpp"
#include "scenes/lenses.hpp"
#include "scenes/path.hpp"
#include "scenes/shapes.hpp"

namespace quadedge::synthetic {

/// A view before camera noise and rounding.
struct Radiance {
  std::vector<double> grey;  ///< height x width, mean over the pixel area [grey levels]; rays without a hit count as 0
  std::vector<float> depth;  ///< height x width, z along the ray through the pixel centre [m]; 0 without a hit
};

/// Casts `supersampling`^2 rays per pixel on a regular grid. That suffices for band-limited textures but would quantise
/// the position of silhouettes: pixels whose rays or corners hit more than one object get 4 times as many rays, in a
/// low-discrepancy set with a random shift per pixel (unbiased in every direction). \param threads  0: one per
/// processor; the result does not depend on it
/// \param extra    an additional surface in the scene, or null
Radiance render(const Scene& scene, const PixelRays& rays, const Eigen::Isometry3d& camera_from_world,
                int supersampling, int threads, const Surface* extra = nullptr);

// Disturbances of rendered images: motion blur and a moving board.

/// A textured board that sways in front of the camera, independently of it and always in view.
class MovingBoard {
 public:
  /// \param fraction of the left image that it covers
  MovingBoard(const PinholeCamera& left, double fraction, std::uint64_t seed);
  /// Its surface after `phase` frames, in front of the left camera at `scene_from_left`.
  Surface surface(double phase, const Eigen::Isometry3d& scene_from_left) const;

 private:
  double half_width_, half_height_;  // [m]
  double sway_x_, sway_y_;           // [m]
  TexturePointer texture_;
};

/// Scene, cameras and exposure time of a view.
struct Exposure {
  const Scene& scene;
  const MovingBoard* board;  ///< or null
  const StereoRig& rig;
  const PixelRays& rays;  ///< rays of the rendered camera
  const CameraPath& path;
  double duration;  ///< [frame periods]; 0: instantaneous
  int supersampling, threads;
};

/// One view exposed around the time of `frame`: the mean over two moments per pixel of image motion. The depth is that
/// at the time of the frame.
Radiance expose(const Exposure& exposure, int frame, Side side);

}  // namespace quadedge::synthetic
