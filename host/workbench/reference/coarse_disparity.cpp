/// \file coarse_disparity.cpp  Birchfield-Tomasi costs, paths in four directions, left-right check, parabola.
#include "reference/coarse_disparity.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace quadedge::reference {
namespace {

/// Values of an image at half size.
struct HalfImage {
  std::size_t place(int x, int y) const { return static_cast<std::size_t>(y * width + x); }
  /// Beyond the border, the value on it.
  int at(int x, int y) const { return values[place(std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1))]; }

  int width, height;
  std::vector<int> values;
};

/// Means of 2 x 2 pixels, rounded grey levels; what exceeds them is left out.
HalfImage halved(const ImageView& image, int height) {
  HalfImage half{image.width / 2, height, {}};
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      const int sum = image.value(2 * x, 2 * y) + image.value(2 * x + 1, 2 * y) + image.value(2 * x, 2 * y + 1) +
                      image.value(2 * x + 1, 2 * y + 1);
      half.values.push_back((sum * 255 + 2 * image.max_value) / (4 * image.max_value));
    }
  }
  return half;
}

/// Sobel's slope along the rows.
HalfImage slopes(const HalfImage& image) {
  HalfImage result{image.width, image.height, {}};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      int slope = 0;
      for (int dy = -1; dy <= 1; ++dy) slope += (dy == 0 ? 2 : 1) * (image.at(x + 1, y + dy) - image.at(x - 1, y + dy));
      result.values.push_back(std::clamp(slope / 2, -kCoarseSlope, +kCoarseSlope) + kCoarseSlope);
    }
  }
  return result;
}

HalfImage half_levels(HalfImage image) {
  for (int& value : image.values) value /= 2;
  return image;
}

/// How far a value of `a` lies outside the values that `b` takes within half a pixel.
int outside(const HalfImage& a, int ax, const HalfImage& b, int bx, int y) {
  const int value = a.at(ax, y), middle = b.at(bx, y), left = (middle + b.at(bx - 1, y)) / 2,
            right = (middle + b.at(bx + 1, y)) / 2;
  return std::max({value - std::max({middle, left, right}), std::min({middle, left, right}) - value, 0});
}

/// The dissimilarity of Birchfield and Tomasi, which sampling does not affect.
int dissimilarity(const HalfImage& left, int x, const HalfImage& right, int right_x, int y) {
  return std::min(outside(left, x, right, right_x, y), outside(right, right_x, left, x, y));
}

class Matcher {
 public:
  Matcher(const ImageView& left, const ImageView& right, const CoarseDisparityArguments& search)
      : search_(search), levels_(static_cast<std::size_t>(search.levels)) {
    const HalfImage left_half = halved(left, search.height), right_half = halved(right, search.height);
    const HalfImage left_slopes = slopes(left_half), right_slopes = slopes(right_half);
    const HalfImage left_levels = half_levels(left_half), right_levels = half_levels(right_half);
    for (int y = 0; y < search.height; ++y) {
      for (int x = 0; x < search.width; ++x) {
        for (int d = 0; d < search.levels; ++d) {
          const int at = std::clamp(counterpart(x, d), 0, search.right_width - 1);
          costs_.push_back(dissimilarity(left_slopes, x, right_slopes, at, y) +
                           dissimilarity(left_levels, x, right_levels, at, y));
        }
      }
    }
    sums_.assign(costs_.size(), 0);
    for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)})
      add_paths(dx, dy);
  }

  float position(int x, int y) const {
    const int* sums = &sums_[cell(x, y)];
    const int best = static_cast<int>(std::min_element(sums, sums + search_.levels) - sums);
    const int at = counterpart(x, best);
    const bool is_seen = at >= 0 && at < search_.right_width && best > 0 && best + 1 < search_.levels;
    if (!is_seen || std::abs(best_of_right(at, y) - best) > 1) return kNoCoarseDisparity;
    const int below = sums[best - 1] - sums[best], above = sums[best + 1] - sums[best];
    const float part =
        below + above > 0 ? static_cast<float>(below - above) / static_cast<float>(2 * std::max(below, above)) : 0.0F;
    return search_.first + 2.0F * (static_cast<float>(best) + part);
  }

 private:
  std::size_t cell(int x, int y) const { return static_cast<std::size_t>(y * search_.width + x) * levels_; }
  int counterpart(int x, int d) const { return x + search_.shift - d; }

  /// Level with the lowest sum for column `at` of the right image.
  int best_of_right(int at, int y) const {
    int best = -1, least = 0;
    for (int d = 0; d < search_.levels; ++d) {
      const int x = at - search_.shift + d;
      if (x < 0 || x >= search_.width) continue;
      const int sum = sums_[cell(x, y) + static_cast<std::size_t>(d)];
      if (best < 0 || sum < least) {
        best = d;
        least = sum;
      }
    }
    return best;
  }

  /// The paths that step by (dx, dy) from border to border.
  void add_paths(int dx, int dy) {
    std::vector<int> path(costs_.size());
    for (int step_y = 0; step_y < search_.height; ++step_y) {
      for (int step_x = 0; step_x < search_.width; ++step_x) {
        const int x = dx < 0 ? search_.width - 1 - step_x : step_x, y = dy < 0 ? search_.height - 1 - step_y : step_y;
        const int from_x = x - dx, from_y = y - dy;
        const bool starts = from_x < 0 || from_y < 0 || from_x >= search_.width || from_y >= search_.height;
        if (!starts) step(&path[cell(from_x, from_y)], &path[cell(x, y)]);
        for (std::size_t at = cell(x, y); at < cell(x, y) + levels_; ++at) {
          path[at] += costs_[at];
          sums_[at] += path[at];
        }
      }
    }
  }

  /// What the levels of a pixel cost on a path, without their own costs.
  void step(const int* before, int* now) const {
    const int lowest = *std::min_element(before, before + search_.levels);
    for (int d = 0; d < search_.levels; ++d) {
      int cheapest = std::min(before[d], lowest + search_.jump_penalty);
      if (d > 0) cheapest = std::min(cheapest, before[d - 1] + search_.step_penalty);
      if (d + 1 < search_.levels) cheapest = std::min(cheapest, before[d + 1] + search_.step_penalty);
      now[d] = cheapest - lowest;
    }
  }

  CoarseDisparityArguments search_;
  std::size_t levels_;
  std::vector<int> costs_, sums_;  // levels innermost
};

}  // namespace

CoarseDisparity coarse_disparity(const ImageView& left, const ImageView& right,
                                 const CoarseDisparityArguments& search) {
  const Matcher matcher(left, right, search);
  CoarseDisparity result{search, {}};
  for (int y = 0; y < search.height; ++y)
    for (int x = 0; x < search.width; ++x) result.positions.push_back(matcher.position(x, y));
  return result;
}

}  // namespace quadedge::reference
