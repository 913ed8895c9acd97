/// \file patch_search.cpp  Box sums by integral images; the strongest corner of each cell; exhaustive search by NCC.
#include "rig/patch_search.hpp"

#include <algorithm>
#include <cmath>

#include "common/parallel.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {
namespace {

constexpr int kPatchHalf = 4, kPatchSide = 2 * kPatchHalf + 1;  // patches of 9 x 9 px
constexpr int kCornerHalf = 3;                                  // half the window size of the structure tensor [px]

/// Sums over squares of half side `half` around every pixel; 0 if the square leaves the image.
std::vector<double> box_sums(const std::vector<double>& values, int width, int height, int half) {
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width + 1) + static_cast<std::size_t>(x);
  };
  std::vector<double> integral(static_cast<std::size_t>(width + 1) * static_cast<std::size_t>(height + 1), 0.0);
  for (int y = 0; y < height; ++y) {
    double row = 0;
    for (int x = 0; x < width; ++x) {
      row += values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
      integral[at(x + 1, y + 1)] = integral[at(x + 1, y)] + row;
    }
  }
  std::vector<double> sums(values.size(), 0.0);
  for (int y = half; y < height - half; ++y) {
    for (int x = half; x < width - half; ++x) {
      sums[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
          integral[at(x + half + 1, y + half + 1)] - integral[at(x - half, y + half + 1)] -
          integral[at(x + half + 1, y - half)] + integral[at(x - half, y - half)];
    }
  }
  return sums;
}

/// Products of the patch around `corner` with the patches centred at `columns` consecutive pixels of row `y`, starting
/// at column `x`. Those of kAtOnce columns are added up in registers; the last ones overlap those before.
QUADEDGE_VECTOR_CLONES
void multiply(const GreyPlane& from, const Eigen::Vector2i& corner, const GreyPlane& to, int x, int y, int columns,
              float* products) {
  const float mean = from.mean[from.index(corner.x(), corner.y())];
  for (int first = 0; first < columns; first += kAtOnce) {
    const int begin = std::max(0, std::min(first, columns - kAtOnce));
    float sums[kAtOnce] = {};
    for (int v = -kPatchHalf; v <= kPatchHalf; ++v) {
      for (int u = -kPatchHalf; u <= kPatchHalf; ++u) {
        const float weight = from.grey[from.index(corner.x() + u, corner.y() + v)] - mean;
        const float* const row = &to.grey[to.index(x + u, y + v)] + begin;
        for (int i = 0; i < kAtOnce; ++i) sums[i] += weight * row[i];
      }
    }
    std::copy_n(sums, std::min(kAtOnce, columns), products + begin);
  }
}

/// Position of the vertex of the parabola through three values, relative to the middle one.
double peak(double before, double middle, double after) {
  const double bend = before - 2 * middle + after;
  return bend < 0 ? std::clamp((before - after) / (2 * bend), -0.5, 0.5) : 0;
}

}  // namespace

void measure_patches(GreyPlane& plane) {
  std::vector<double> grey(plane.grey.begin(), plane.grey.end()), squares(grey.size());
  std::transform(grey.begin(), grey.end(), squares.begin(), [](double value) { return value * value; });
  const auto sums = box_sums(grey, plane.width, plane.height, kPatchHalf),
             square_sums = box_sums(squares, plane.width, plane.height, kPatchHalf);
  constexpr double kCount = kPatchSide * kPatchSide;
  plane.mean.resize(grey.size());
  plane.norm.resize(grey.size());
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const double mean = sums[i] / kCount, spread = square_sums[i] - kCount * mean * mean;
    plane.mean[i] = static_cast<float>(mean);
    plane.norm[i] = spread > kCount * kFlat * kFlat ? static_cast<float>(std::sqrt(spread)) : 0.0F;
  }
}

std::vector<Eigen::Vector2i> find_corners(const GreyPlane& plane, int cell) {
  const int width = plane.width, height = plane.height;
  std::vector<double> xx(plane.grey.size(), 0.0), xy = xx, yy = xx;
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      const auto i = plane.index(x, y);
      const double gx = 0.5 * static_cast<double>(plane.grey[i + 1] - plane.grey[i - 1]);
      const double gy =
          0.5 * static_cast<double>(plane.grey[plane.index(x, y + 1)] - plane.grey[plane.index(x, y - 1)]);
      xx[i] = gx * gx;
      xy[i] = gx * gy;
      yy[i] = gy * gy;
    }
  }
  xx = box_sums(xx, width, height, kCornerHalf);
  xy = box_sums(xy, width, height, kCornerHalf);
  yy = box_sums(yy, width, height, kCornerHalf);
  constexpr double kLimit = kMinCorner * (2 * kCornerHalf + 1) * (2 * kCornerHalf + 1);
  std::vector<Eigen::Vector2i> corners;
  for (int top = kPatchHalf; top < height - kPatchHalf; top += cell) {
    for (int left = kPatchHalf; left < width - kPatchHalf; left += cell) {
      double strongest = kLimit;
      Eigen::Vector2i position(-1, -1);
      for (int y = top; y < std::min(top + cell, height - kPatchHalf); ++y) {
        for (int x = left; x < std::min(left + cell, width - kPatchHalf); ++x) {
          const auto i = plane.index(x, y);
          const double half = 0.5 * (xx[i] + yy[i]);
          const double smaller = half - std::sqrt(std::max(0.0, half * half - (xx[i] * yy[i] - xy[i] * xy[i])));
          if (smaller <= strongest || !(plane.norm[i] > 0)) continue;
          strongest = smaller;
          position = {x, y};
        }
      }
      if (position.x() >= 0) corners.push_back(position);
    }
  }
  return corners;
}

std::optional<PatchMatch> best_match(const GreyPlane& from, const GreyPlane& to, const Eigen::Vector2i& corner,
                                     const SearchBox& box) {
  const auto here = from.index(corner.x(), corner.y());
  if (!(from.norm[here] > 0)) return std::nullopt;
  const int x_low = std::max(corner.x() - box.half_width, kPatchHalf),
            x_high = std::min(corner.x() + box.half_width, to.width - 1 - kPatchHalf);
  const int y_low = std::max(corner.y() - box.half_height, kPatchHalf),
            y_high = std::min(corner.y() + box.half_height, to.height - 1 - kPatchHalf);
  const int columns = x_high - x_low + 1, rows = y_high - y_low + 1;
  if (columns < 1 || rows < 1) return std::nullopt;
  std::vector<float> correlation(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0.0F);
  for (int y = y_low; y <= y_high; ++y) {
    float* const out = &correlation[static_cast<std::size_t>(y - y_low) * static_cast<std::size_t>(columns)];
    multiply(from, corner, to, x_low, y, columns, out);
    for (int i = 0; i < columns; ++i) {
      const float norm = to.norm[to.index(x_low + i, y)];
      out[i] = norm > 0 ? out[i] / (from.norm[here] * norm) : 0.0F;
    }
  }
  const auto best = std::max_element(correlation.begin(), correlation.end(),
                                     [](float a, float b) { return std::fabs(a) < std::fabs(b); });
  if (std::fabs(*best) < static_cast<float>(kMinCorrelation)) return std::nullopt;
  const auto position = static_cast<int>(best - correlation.begin());
  const int x = position % columns, y = position / columns;
  const auto value = [&](int column, int row) {
    column = std::clamp(column, 0, columns - 1);
    row = std::clamp(row, 0, rows - 1);
    return std::fabs(static_cast<double>(correlation[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                                                     static_cast<std::size_t>(column)]));
  };
  float other = 0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (std::max(std::abs(column - x), std::abs(row - y)) <= kPatchHalf) continue;
      other = std::max(other, std::fabs(correlation[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                                                    static_cast<std::size_t>(column)]));
    }
  }
  return PatchMatch{{x_low + x + peak(value(x - 1, y), value(x, y), value(x + 1, y)),
                     y_low + y + peak(value(x, y - 1), value(x, y), value(x, y + 1))},
                    static_cast<double>(*best),
                    other < std::fabs(*best) - kUniqueMargin};
}

}  // namespace quadedge::rig
