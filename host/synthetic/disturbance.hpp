#pragma once
/// \file disturbance.hpp  What makes rendered images worse than a still camera before a still scene: blur and a moving
/// board.

#include <Eigen/Geometry>
#include <memory>

#include "quadedge/camera.hpp"
#include "quadedge/side.hpp"
#include "synthetic/render.hpp"
#include "synthetic/shapes.hpp"

namespace quadedge::synthetic {

/// A textured board that sways before the camera on a path of its own, always in view.
class MovingBoard {
 public:
  /// \param fraction of the left image that it covers
  MovingBoard(const PinholeCamera& left, double fraction, std::uint64_t seed);
  /// Its surface after `phase` frames.
  PlaneSurface surface(double phase) const;

 private:
  double half_width_, half_height_;  // [m]
  double sway_x_, sway_y_;           // [m]
  std::shared_ptr<const Texture> texture_;
};

/// One view with the shutter open around the time of `frame`: the mean over as many moments as `blur` asks for. The
/// depth is the one at the frame's own time. \param board null without \param blur  way of the image's middle, at 2.5
/// m, while the shutter is open [px]; the camera's motion sets how long that takes, at
///              most two frame periods
Radiance expose(const Scene& scene, const MovingBoard* board, const StereoRig& rig, Side side, int frame, double blur,
                int supersampling, int threads);

}  // namespace quadedge::synthetic
