#pragma once
/// \file render.hpp  Casts the rays of one view.

#include <vector>

#include "synthetic/pixel_rays.hpp"
#include "synthetic/shapes.hpp"

namespace quadedge::synthetic {

/// A view before the camera's noise and rounding.
struct Radiance {
  std::vector<double>
      grey;  ///< height x width, mean over the pixel's square [grey levels]; rays that hit nothing count 0
  std::vector<float> depth;  ///< height x width, z of the ray through the pixel's centre [m]; 0 where it hits nothing
};

/// Casts `supersampling`^2 rays per pixel, a regular grid over its square. That is enough for band-limited textures,
/// but a silhouette's place would be rounded to a part of the grid's step: pixels whose rays or corners meet more than
/// one object get 4 times as many, in a low-discrepancy set that is shifted at random from pixel to pixel (unbiased in
/// every direction). \param threads  0: one per processor. The result does not depend on it. \param extra    one more
/// surface in the scene, or null
Radiance render(const Scene& scene, const PixelRays& rays, const Eigen::Isometry3d& camera_from_world,
                int supersampling, int threads, const Surface* extra = nullptr);

}  // namespace quadedge::synthetic
