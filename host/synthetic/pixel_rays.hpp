#pragma once
/// \file pixel_rays.hpp  Where the pixels of a rendered camera look, through any lens.

#include <Eigen/Core>
#include <vector>

#include "quadedge/lens.hpp"
#include "synthetic/shapes.hpp"

namespace quadedge::synthetic {

/// The rays of an image's pixels, normalised to (x, y, 1). Exact in the centres and corners of pixels; within a pixel a
/// lens's rays are spread evenly. Pixels that look more than 80 degrees away from the optical axis see nothing.
class PixelRays {
 public:
  PixelRays(const Lens& lens);
  PixelRays(const PinholeCamera& camera) : PixelRays(Lens{LensModel::radial_tangential, camera, {}}) {}

  int width() const { return camera_.width; }
  int height() const { return camera_.height; }
  bool is_seen(int x, int y) const { return table_.empty() || table_[index(x, y)].seen; }
  Eigen::Vector3d centre(int x, int y) const;
  /// The top left corner of a pixel; those of the last column and row plus one are the image's corners.
  Eigen::Vector3d corner(int x, int y) const;
  /// `offset` from the centre, up to half a pixel.
  Eigen::Vector3d within(int x, int y, const Eigen::Vector2d& offset) const;
  /// Pixels per unit at unit depth, where a pixel looks.
  double focal_length(int x, int y) const;

  /// A pinhole camera that sees all that is seen: surfaces tell in its pixels where they may show.
  const PinholeCamera& pinhole() const { return pinhole_; }
  /// Pixels of pinhole() that meet a box of pixels.
  PixelBox footprint(const PixelBox& pixels) const;

 private:
  struct Pixel {
    Eigen::Vector2d centre = Eigen::Vector2d::Zero(), corner = Eigen::Vector2d::Zero();  ///< at unit depth
    bool seen = false;
  };
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width + 1) + static_cast<std::size_t>(x);
  }
  /// Right and lower minus left and upper side of a pixel, at unit depth.
  Eigen::Matrix2d spread(int x, int y) const;

  PinholeCamera camera_, pinhole_;
  std::vector<Pixel> table_;  ///< one column and row more than the image; empty: a pinhole camera
};

}  // namespace quadedge::synthetic
