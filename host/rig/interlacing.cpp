/// \file interlacing.cpp  Correlates row differences of alternating sign with the horizontal gradient, per cell.
#include "rig/interlacing.hpp"

#include <algorithm>
#include <cmath>

#include "quadedge/camera.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {
namespace {

/// Sums over the pixels of a cell: a row that is shifted by s differs from the mean of its neighbours by s times the
/// horizontal gradient, with the opposite sign in the next row.
struct Comb {
  double product = 0;      ///< of alternating differences and gradients
  double gradients = 0;    ///< squared
  double differences = 0;  ///< squared
};

Comb comb_of(const ImageView& image, int left, int top) {
  Comb comb;
  const double level = 1.0 * kMaxValue8 / image.max_value;
  for (int y = std::max(top, 1); y < std::min(top + kCombCell, image.height - 1); ++y) {
    const double sign = y % 2 == 0 ? level : -level;
    for (int x = std::max(left, 1); x < std::min(left + kCombCell, image.width - 1); ++x) {
      const double gradient = level * 0.5 * (image.value(x + 1, y) - image.value(x - 1, y));
      const double difference = sign * (image.value(x, y) - 0.5 * (image.value(x, y - 1) + image.value(x, y + 1)));
      comb.product += gradient * difference;
      comb.gradients += gradient * gradient;
      comb.differences += difference * difference;
    }
  }
  return comb;
}

}  // namespace

double combed_ratio(const ImageView& image) {
  int textured = 0, combed = 0;
  for (int top = 0; top + kCombCell <= image.height; top += kCombCell) {
    for (int left = 0; left + kCombCell <= image.width; left += kCombCell) {
      const Comb comb = comb_of(image, left, top);
      if (!(comb.gradients > kCombTexture * kCombCell * kCombCell)) continue;
      ++textured;
      const double product = std::abs(comb.product);
      combed += product > kCombShift * comb.gradients &&
                product > kCombCorrelation * std::sqrt(comb.gradients * comb.differences);
    }
  }
  return textured < kMinCombCells ? 0 : static_cast<double>(combed) / textured;
}

}  // namespace quadedge::rig
