#pragma once
/// \file disturbance.hpp  Disturbances of rendered images: motion blur and a moving board.

#include <Eigen/Geometry>
#include <memory>

#include "quadedge/camera.hpp"
#include "synthetic/path.hpp"
#include "synthetic/render.hpp"
#include "synthetic/shapes.hpp"

namespace quadedge::synthetic {

/// A textured board that sways in front of the camera, independently of it and always in view.
class MovingBoard {
 public:
  /// \param fraction of the left image that it covers
  MovingBoard(const PinholeCamera& left, double fraction, std::uint64_t seed);
  /// Its surface after `phase` frames, in front of the left camera at `scene_from_left`.
  PlaneSurface surface(double phase, const Eigen::Isometry3d& scene_from_left) const;

 private:
  double half_width_, half_height_;  // [m]
  double sway_x_, sway_y_;           // [m]
  std::shared_ptr<const Texture> texture_;
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
