#pragma once
/// \file path.hpp  Camera motion of the synthetic sequences.

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <string>

#include "quadedge/camera.hpp"
#include "scenes/shapes.hpp"

namespace quadedge::synthetic {

/// A smooth analytic motion of the left camera through a scene.
class CameraPath {
 public:
  /// \param name    one of synthetic_paths()
  /// \param seed    of the phases of the sway; unused by the ellipse
  /// \param frames  of the sequence: the loop closes at the last one
  CameraPath(const std::string& name, std::uint64_t seed, int frames, const Lane& lane);

  /// Pose after `phase` frames (any real number) in the scene frame.
  Eigen::Isometry3d scene_from_left(double phase) const { return motion_(phase); }
  /// The same in the camera frame at phase 0, where it is the identity.
  Eigen::Isometry3d world_from_left(double phase) const;
  /// Maximum number of frames that fit into the scene.
  int longest() const { return longest_; }
  /// Mean displacement of the middle of the image, at 2.5 m, per frame period [px]: over the whole loop or lane,
  /// otherwise over half a minute.
  double mean_image_motion(const PinholeCamera& camera) const;
  /// Largest displacement of the middle and corners of the image, at 2.5 m, within `periods` [frame periods] around
  /// `phase` [px].
  double image_motion(const PinholeCamera& camera, double phase, double periods) const;

 private:
  using Motion = std::function<Eigen::Isometry3d(double)>;
  Motion motion_;
  Eigen::Isometry3d world_from_scene_;
  int longest_;
  int typical_;  // number of frames for mean_image_motion()
};

}  // namespace quadedge::synthetic
