#pragma once
/// \file disturbance.hpp  What makes rendered images worse than a still camera before a still scene: blur and a moving
/// board.

#include <Eigen/Geometry>
#include <memory>

#include "quadedge/camera.hpp"
#include "quadedge/side.hpp"
#include "synthetic/path.hpp"
#include "synthetic/render.hpp"
#include "synthetic/shapes.hpp"

namespace quadedge::synthetic {

/// A textured board that sways before the camera on a path of its own, always in view.
class MovingBoard {
 public:
  /// \param fraction of the left image that it covers
  MovingBoard(const PinholeCamera& left, double fraction, std::uint64_t seed);
  /// Its surface after `phase` frames before the left camera at `scene_from_left`.
  PlaneSurface surface(double phase, const Eigen::Isometry3d& scene_from_left) const;

 private:
  double half_width_, half_height_;  // [m]
  double sway_x_, sway_y_;           // [m]
  std::shared_ptr<const Texture> texture_;
};

/// What is seen, from where, and for how long the shutter is open.
struct Exposure {
  const Scene& scene;
  const MovingBoard* board;  ///< or null
  const StereoRig& rig;
  const PixelRays& rays;  ///< of the camera whose view it is
  const CameraPath& path;
  double duration;  ///< [frame periods]; 0: an instant
  int supersampling, threads;
};

/// One view with the shutter open around the time of `frame`: the mean over two moments per pixel of the image's
/// motion. The depth is the one at the frame's own time.
Radiance expose(const Exposure& exposure, int frame, Side side);

}  // namespace quadedge::synthetic
