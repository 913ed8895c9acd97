#pragma once
/// \file patch_search.hpp  Corners of a small image, and where in another one a patch around them lies. The core
/// library does without OpenCV, which has both.

#include <Eigen/Core>
#include <optional>
#include <tbb/parallel_for.h>
#include <vector>

namespace quadedge::odometry {

/// A small grey image of floats, with what normalised correlation needs of every patch.
struct GreyPlane {
  int width = 0, height = 0;
  std::vector<float> grey;  ///< height x width, row-major
  std::vector<float> mean;  ///< of the patch around every pixel
  std::vector<float> norm;  ///< of its differences from the mean; 0 where the patch is flat or leaves the image

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// Fills mean and norm of an image whose grey values are set.
void measure_patches(GreyPlane& plane);

/// An image whose pixels are the mean of value(x, y) at four places a half pixel apart.
template <class Value>
GreyPlane sample_plane(int width, int height, const Value& value) {
  GreyPlane plane{width, height, {}, {}, {}};
  plane.grey.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      plane.grey[plane.index(x, y)] = 0.25F * (value(x - 0.25, y - 0.25) + value(x + 0.25, y - 0.25) +
                                               value(x - 0.25, y + 0.25) + value(x + 0.25, y + 0.25));
    }
  });
  measure_patches(plane);
  return plane;
}

/// The strongest corner (Shi and Tomasi, Good features to track, 1994) of every cell of the image that has one.
std::vector<Eigen::Vector2i> find_corners(const GreyPlane& plane);

/// How far from where it lies a patch is sought, to both sides [px].
struct SearchBox {
  int half_width = 0, half_height = 0;
};

/// Where a patch was found.
struct PatchMatch {
  Eigen::Vector2d at;      ///< [px], with a part of a pixel
  double correlation = 0;  ///< normalised; below zero where a negative was found
};

/// The place in `to`, in a box around `corner`, whose patch correlates most, in either sign, with that of `from` at
/// `corner`; nothing where none does well.
std::optional<PatchMatch> best_match(const GreyPlane& from, const GreyPlane& to, const Eigen::Vector2i& corner,
                                     const SearchBox& box);

}  // namespace quadedge::odometry
