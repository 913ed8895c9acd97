#pragma once
/// \file patch_search.hpp  Corner detection and patch search in small images. OpenCV has both, but the core library
/// does not link OpenCV.

#include <Eigen/Core>
#include <optional>
#include <tbb/parallel_for.h>
#include <vector>

namespace quadedge::rig {

constexpr int kAtOnce = 32;  ///< columns whose correlations are computed together, also beyond a narrow box

/// A small grey image of floats with the patch statistics that normalised correlation needs.
struct GreyPlane {
  int width = 0, height = 0;
  std::vector<float> grey;  ///< height x width, row-major, then kAtOnce zeros
  std::vector<float> mean;  ///< of the patch around every pixel
  std::vector<float> norm;  ///< of its deviations from the mean; 0 if the patch is flat or leaves the image

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// Computes `mean` and `norm` from `grey`.
void measure_patches(GreyPlane& plane);

/// Creates an image whose pixels are the mean of value(x, y) at four positions half a pixel apart.
template <class Value>
GreyPlane sample_plane(int width, int height, const Value& value) {
  GreyPlane plane{width, height, {}, {}, {}};
  plane.grey.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) + kAtOnce);
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      plane.grey[plane.index(x, y)] = 0.25F * (value(x - 0.25, y - 0.25) + value(x + 0.25, y - 0.25) +
                                               value(x - 0.25, y + 0.25) + value(x + 0.25, y + 0.25));
    }
  });
  measure_patches(plane);
  return plane;
}

/// The strongest corner of every image cell of `cell` x `cell` px that has one (Shi and Tomasi, Good features to track,
/// 1994).
std::vector<Eigen::Vector2i> find_corners(const GreyPlane& plane, int cell);

/// Extent of the search to both sides [px].
struct SearchBox {
  int half_width = 0, half_height = 0;
};

/// Position at which a patch was found.
struct PatchMatch {
  Eigen::Vector2d at;      ///< [px], with sub-pixel accuracy
  double correlation = 0;  ///< normalised; negative for an inverted patch
};

/// The position in `to`, within a box around `corner`, whose patch has the largest absolute correlation with the patch
/// of `from` at `corner`; nothing if the correlation is too low.
std::optional<PatchMatch> best_match(const GreyPlane& from, const GreyPlane& to, const Eigen::Vector2i& corner,
                                     const SearchBox& box);

}  // namespace quadedge::rig
