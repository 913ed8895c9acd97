#pragma once
/// \file render.hpp  Renders one view by ray casting.

#include <vector>

#include "synthetic/pixel_rays.hpp"
#include "synthetic/shapes.hpp"

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

}  // namespace quadedge::synthetic
