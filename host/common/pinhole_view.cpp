#include "common/pinhole_view.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "common/bilinear.hpp"
#include "common/vector_clones.hpp"

namespace quadedge {

namespace {

float grey_at(const ImageView& recorded, double x, double y) {
  return bilinear(recorded.width, recorded.height, x, y, [&](int column, int row) { return recorded.at(column, row); });
}

constexpr int kColumns = 16;  // of a row of samples, computed at once

/// Positions in a recorded image: (x, y) + (column (column_x, column_y) + (row_x, row_y)).
struct SampleRow {
  double x, y, column_x, column_y, row_x, row_y;
};

/// bilinear_inside() at up to kColumns consecutive positions, of which the first is that of column `first`.
QUADEDGE_VECTOR_CLONES
void sample_row(const ImageView& image, const SampleRow& row, int first, int count, float* values) {
  float right[kColumns], below[kColumns];  // fractions
  std::ptrdiff_t corner[kColumns];         // index of the pixel above on the left
  float pixels[4][kColumns] = {};
  const std::ptrdiff_t stride = image.stride;
  for (int k = 0; k < kColumns; ++k) {
    const double column = first + k, x = row.x + (row.column_x * column + row.row_x),
                 y = row.y + (row.column_y * column + row.row_y);
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    right[k] = static_cast<float>(x - x0);
    below[k] = static_cast<float>(y - y0);
    corner[k] = y0 * stride + x0;
  }
  for (int k = 0; k < count; ++k) {
    const std::uint8_t* const pixel = image.pixels + corner[k];
    pixels[0][k] = pixel[0];
    pixels[1][k] = pixel[1];
    pixels[2][k] = pixel[stride];
    pixels[3][k] = pixel[stride + 1];
  }
  float sampled[kColumns];
  for (int k = 0; k < kColumns; ++k) {
    const float above = (1 - right[k]) * pixels[0][k] + right[k] * pixels[1][k];
    const float under = (1 - right[k]) * pixels[2][k] + right[k] * pixels[3][k];
    sampled[k] = (1 - below[k]) * above + below[k] * under;
  }
  std::copy(sampled, sampled + count, values);
}

}  // namespace

Eigen::Vector2d PinholeView::recorded_position(const Eigen::Vector2d& position) const {
  if (table_.empty()) return position;
  return {static_cast<double>(bilinear(table_, table_.source_x, position.x(), position.y())),
          static_cast<double>(bilinear(table_, table_.source_y, position.x(), position.y()))};
}

float PinholeView::at(double x, double y) const {
  const Eigen::Vector2d position = recorded_position({x, y});
  return grey_at(recorded_, position.x(), position.y());
}

PinholeView::Patch PinholeView::patch(const Eigen::Vector2d& position, const Eigen::Matrix2d& steps) const {
  if (table_.empty()) return {recorded_, position, steps};
  constexpr double kStep = 4;  // step for the derivative of the lens mapping [px]
  Eigen::Matrix2d slope;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(axis);
    slope.col(axis) = (recorded_position(position + step) - recorded_position(position - step)) / (2 * kStep);
  }
  return {recorded_, recorded_position(position), slope * steps};
}

void PinholeView::Patch::sample(int half, float* values) const {
  const int side = 2 * half + 1;
  const Eigen::Vector2d reach = half * steps_.cwiseAbs().rowwise().sum();
  const Eigen::Vector2d first = middle_ - reach, last = middle_ + reach;
  const bool is_inside = first.minCoeff() >= 0 && last.x() < recorded_.width - 1 && last.y() < recorded_.height - 1;
  for (int row = -half; row <= half; ++row, values += side) {
    if (!is_inside || recorded_.max_value != kMaxValue8) {
      for (int column = 0; column < side; ++column) {
        const Eigen::Vector2d position = middle_ + steps_ * Eigen::Vector2d(column - half, row);
        values[column] = grey_at(recorded_, position.x(), position.y());
      }
      continue;
    }
    const Eigen::Vector2d of_row = row * steps_.col(1);
    const SampleRow samples{middle_.x(), middle_.y(), steps_(0, 0), steps_(1, 0), of_row.x(), of_row.y()};
    for (int column = 0; column < side; column += kColumns)
      sample_row(recorded_, samples, column - half, std::min(kColumns, side - column), values + column);
  }
}

}  // namespace quadedge
