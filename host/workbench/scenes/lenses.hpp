#pragma once
/// \file lenses.hpp  The lenses and rigs of the renderer, and the viewing rays of their pixels.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "quadedge/calibration.hpp"
#include "quadedge/camera.hpp"
#include "scenes/shapes.hpp"

namespace quadedge::synthetic {

/// One of synthetic_lenses(), with parameters typical of calibrations of real cameras. `focal`: focal length of the
/// corresponding pinhole camera [px]. Wide-angle lenses have a larger field of view than that camera.
Lens make_lens(const std::string& name, double focal);

/// The cameras of cables_2 of ETH3D's SLAM benchmark (calibration.txt, calibration2.txt, extrinsics_1_2.txt), camera 2,
/// which is the left one, first.
StereoCalibration eth3d_slam_rig();

// Viewing rays of the pixels of a rendered camera, for any lens.

/// Viewing rays of the pixels of an image, normalised to (x, y, 1). Exact at the centres and corners of pixels; within
/// a pixel, the rays of a lens are spaced evenly. Pixels more than 80 degrees away from the optical axis see nothing.
class PixelRays {
 public:
  PixelRays(const Lens& lens);
  PixelRays(const PinholeCamera& camera) : PixelRays(Lens{LensModel::radial_tangential, camera, {}}) {}

  int width() const { return camera_.width; }
  int height() const { return camera_.height; }
  bool is_visible(int x, int y) const { return table_.empty() || table_[index(x, y)].seen; }
  Eigen::Vector3d centre(int x, int y) const;
  /// Ray of the top left corner of a pixel; x and y may equal width and height, for the image's right and lower border.
  Eigen::Vector3d corner(int x, int y) const;
  /// Ray at `offset` from the pixel centre, up to half a pixel.
  Eigen::Vector3d within(int x, int y, const Eigen::Vector2d& offset) const;
  /// The same for several offsets.
  void within(int x, int y, const Eigen::Vector2d* offsets, RayBundle& rays) const;
  /// Local focal length at a pixel: pixels per unit at unit depth.
  double focal_length(int x, int y) const;

  /// A pinhole camera that contains all visible rays; surfaces report their extent in its pixels.
  const PinholeCamera& pinhole() const { return pinhole_; }
  /// Pixels of pinhole() that overlap a box of pixels.
  PixelBox footprint(const PixelBox& pixels) const;

 private:
  struct Pixel {
    Eigen::Vector2d centre = Eigen::Vector2d::Zero(), corner = Eigen::Vector2d::Zero();  ///< at unit depth
    bool seen = false;
  };
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width + 1) + static_cast<std::size_t>(x);
  }
  /// Extent of a pixel at unit depth: differences of opposite sides, along x and y.
  Eigen::Matrix2d spread(int x, int y) const;

  PinholeCamera camera_, pinhole_;
  std::vector<Pixel> table_;  ///< one column and row more than the image; empty for a pinhole camera
};

}  // namespace quadedge::synthetic
