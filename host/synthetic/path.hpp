#pragma once
/// \file path.hpp  How the camera of the synthetic sequences moves.

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <string>

#include "quadedge/camera.hpp"
#include "synthetic/shapes.hpp"

namespace quadedge::synthetic {

/// A smooth analytic motion of the left camera through a scene.
class CameraPath {
 public:
  /// \param name    one of synthetic_paths()
  /// \param seed    of the phases of all swaying; the ellipse has none
  /// \param frames  of the sequence: the loop closes with the last one
  CameraPath(const std::string& name, std::uint64_t seed, int frames, const Lane& lane);

  /// Pose after `phase` frames (any real number) in the frame of the scene.
  Eigen::Isometry3d scene_from_left(double phase) const { return motion_(phase); }
  /// The same in the frame of the camera at phase 0, where it is the identity.
  Eigen::Isometry3d world_from_left(double phase) const;
  /// Length of the longest sequence for which there is way [frames].
  int longest() const { return longest_; }
  /// How far the image's middle, at 2.5 m, moves per frame period on average [px]: over the whole loop or lane, else
  /// over half a minute.
  double mean_image_motion(const PinholeCamera& camera) const;
  /// Largest way of the image's middle and corners, at 2.5 m, in the `periods` [frame periods] around `phase` [px].
  double image_motion(const PinholeCamera& camera, double phase, double periods) const;

 private:
  using Motion = std::function<Eigen::Isometry3d(double)>;
  Motion motion_;
  Eigen::Isometry3d world_from_scene_;
  int longest_;
  int typical_;  // frames that mean_image_motion() is taken over
};

}  // namespace quadedge::synthetic
