#pragma once
/// \file coarse_disparity.hpp  Plain C++ twin of kernels/coarse_disparity.cl.

#include <vector>

#include "geometry/disparity_range.hpp"
#include "quadedge/image.hpp"

namespace quadedge::reference {

struct CoarseDisparity {
  CoarseDisparityArguments search;
  /// search.height x search.width positions on the epipolar lines [px of the images]; kNoCoarseDisparity: not known
  std::vector<float> positions;
};

/// Disparity of a rectified pair at half size by semi-global matching (doc/method.md section 3).
CoarseDisparity coarse_disparity(const ImageView& left, const ImageView& right, const CoarseDisparityArguments& search);

}  // namespace quadedge::reference
