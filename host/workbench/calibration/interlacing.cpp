/// \file interlacing.cpp  Correlates row differences of alternating sign with the horizontal gradient, per cell.
#include "calibration/interlacing.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace quadedge::rig {
namespace {

constexpr int kCombCell = 32;        ///< size of the cells that are judged [px]
constexpr double kCombTexture = 4;   ///< mean squared horizontal gradient of a textured cell [(grey levels per px)^2]
constexpr double kCombShift = 0.25;  ///< shift of odd rows against even ones [px]
constexpr double kCombCorrelation = 0.1;
/// Part of a cell's squared gradient along x that its gradient along y does not explain.
constexpr double kCombOwnGradient = 0.1;

/// Sums of products over the pixels of a cell, of the gradients along x and y and the difference of a row from the mean
/// of its neighbours, with alternating sign. Rows that are shifted by s differ by s times the gradient along x. Those
/// of an image that was enlarged by repeating rows differ by a gradient along y.
Eigen::Matrix3d products_of(const ImageView& image, int left, int top) {
  Eigen::Matrix3d sums = Eigen::Matrix3d::Zero();
  const double level = 1.0 * kMaxValue8 / image.max_value;
  for (int y = std::max(top, 1); y < std::min(top + kCombCell, image.height - 1); ++y) {
    const double sign = y % 2 == 0 ? 1 : -1;
    for (int x = std::max(left, 1); x < std::min(left + kCombCell, image.width - 1); ++x) {
      const double above = image.value(x, y - 1), below = image.value(x, y + 1);
      const Eigen::Vector3d pixel(0.5 * (image.value(x + 1, y) - image.value(x - 1, y)), 0.5 * (below - above),
                                  sign * (image.value(x, y) - 0.5 * (above + below)));
      sums += level * level * pixel * pixel.transpose();
    }
  }
  return sums;
}

/// Whether products show a shift of the rows.
bool is_combed(const Eigen::Matrix3d& products) {
  const double along_x = products(0, 0), shift = std::abs(products(0, 2));
  return shift > kCombShift * along_x && shift > kCombCorrelation * std::sqrt(along_x * products(2, 2));
}

}  // namespace

void Combing::add(const ImageView& image) {
  for (int top = 0; top + kCombCell <= image.height; top += kCombCell) {
    for (int left = 0; left + kCombCell <= image.width; left += kCombCell) {
      const Eigen::Matrix3d all = products_of(image, left, top);
      if (!(all(0, 0) > kCombTexture * kCombCell * kCombCell)) continue;
      ++textured_;
      const Eigen::Matrix3d without_y = all - all.col(1) * all.row(1) / std::max(all(1, 1), 1e-9);
      combed_ += is_combed(all) && without_y(0, 0) > kCombOwnGradient * all(0, 0) && is_combed(without_y) ? 1 : 0;
    }
  }
}

}  // namespace quadedge::rig
