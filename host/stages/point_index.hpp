#pragma once
/// \file point_index.hpp  Points ordered by row, so that "points near this place" costs what it returns.

#include <cstdint>
#include <vector>

namespace quadedge::stages {

/// Points sorted by row of the doubled grid (round(2 y)), then x, then index.
struct PointIndex {
  std::vector<std::int32_t> row_first;  ///< 2 * height + 1
  std::vector<std::int32_t> order;      ///< indices of the points in that order
};

/// `height`: of the image [px]; rows outside it count to the nearest one.
PointIndex make_point_index(const std::vector<float>& xs, const std::vector<float>& ys, int height);

}  // namespace quadedge::stages
