#pragma once
/// \file patch_search.hpp  Corner detection and patch search in small images. OpenCV has both, but the core library
/// does not link OpenCV.

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <tbb/parallel_for.h>
#include <vector>

#include "geometry/undistortion.hpp"

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

/// A reduced image of what a view shows. \param place position in the view of a position in the reduced image, as
/// std::optional; pixels without one are black
template <class Place>
GreyPlane sample_plane(const PinholeView& view, int width, int height, const Place& place) {
  constexpr int kBlock = PinholeView::kBlock;
  GreyPlane plane{width, height, {}, {}, {}};
  plane.grey.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) + kAtOnce);
  tbb::parallel_for(0, (height + kBlock - 1) / kBlock, [&](int row_of_blocks) {
    const int top = row_of_blocks * kBlock, rows = std::min(kBlock, height - top);
    for (int left = 0; left < width; left += kBlock) {
      const Eigen::Vector2d middle(left + 0.5 * (kBlock - 1), top + 0.5 * (kBlock - 1));
      const auto at = place(middle), beside = place(middle + Eigen::Vector2d(0.5 * kBlock, 0)),
                 below = place(middle + Eigen::Vector2d(0, 0.5 * kBlock));
      if (!at || !beside || !below) continue;
      Eigen::Matrix2d steps;
      steps << *beside - *at, *below - *at;
      float values[kBlock * kBlock];
      view.reduced(*at, steps / (0.5 * kBlock), values);
      for (int row = 0; row < rows; ++row)
        std::copy_n(values + row * kBlock, std::min(kBlock, width - left), &plane.grey[plane.index(left, top + row)]);
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
  bool is_unique = true;   ///< whether no other place in the box is about as similar, as texture is that repeats
};

/// The position in `to`, within a box around `corner`, whose patch has the largest absolute correlation with the patch
/// of `from` at `corner`; nothing if the correlation is too low.
std::optional<PatchMatch> best_match(const GreyPlane& from, const GreyPlane& to, const Eigen::Vector2i& corner,
                                     const SearchBox& box);

}  // namespace quadedge::rig
