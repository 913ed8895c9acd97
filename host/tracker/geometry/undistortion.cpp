/// \file undistortion.cpp  Samples rows bilinearly in vectors; patches follow the lens mapping to first order.
#include "geometry/undistortion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "common/parallel.hpp"

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

/// bilinear() inside the image at up to kColumns consecutive positions, of which the first is that of column `first`.
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

/// Ratio of the two focal lengths in pixels from which a camera is reduced to a fraction of its resolution: half-way to
/// twice the resolution.
constexpr double kMinScaleRatio = 1.5;

/// Reduces a mask by `factor`; a pixel is hidden if any of its source pixels is.
void shrink(int factor, const PinholeCamera& camera, PixelMask& mask) {
  if (mask.empty()) return;
  PixelMask smaller{camera.width / factor, camera.height / factor, {}};
  const auto at = [&](const PixelMask& grid, int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.width) + static_cast<std::size_t>(x);
  };
  smaller.hidden.resize(at(smaller, 0, smaller.height));
  for (int y = 0; y < factor * smaller.height; ++y)
    for (int x = 0; x < factor * smaller.width; ++x)
      if (mask.hidden[at(mask, x, y)] != 0) smaller.hidden[at(smaller, x / factor, y / factor)] = 1;
  mask = std::move(smaller);
}

/// Reduces a camera and its table by `factor`.
void shrink(int factor, PinholeCamera& camera, UndistortionTable& table) {
  UndistortionTable smaller;
  smaller.width = camera.width / factor;
  smaller.height = camera.height / factor;
  smaller.recorded_width = table.empty() ? camera.width : table.recorded_width;
  smaller.recorded_height = table.empty() ? camera.height : table.recorded_height;
  for (int y = 0; y < smaller.height; ++y) {
    for (int x = 0; x < smaller.width; ++x) {
      const double from_x = (x + 0.5) * factor - 0.5, from_y = (y + 0.5) * factor - 0.5;
      const Eigen::Array2f from =
          table.empty() ? Eigen::Array2d(from_x, from_y).cast<float>().eval() : source(table, from_x, from_y);
      smaller.source_x.change().push_back(from.x());
      smaller.source_y.change().push_back(from.y());
    }
  }
  table = std::move(smaller);
  camera.fx /= factor;
  camera.fy /= factor;
  camera.cx = (camera.cx + 0.5) / factor - 0.5;
  camera.cy = (camera.cy + 0.5) / factor - 0.5;
  camera.width /= factor;
  camera.height /= factor;
}

double focal_length(const PinholeCamera& camera) { return std::sqrt(camera.fx * camera.fy); }

void shrink_camera(double times, PinholeCamera& camera, UndistortionTable& table, PixelMask& mask) {
  if (times < kMinScaleRatio) return;
  const int factor = static_cast<int>(std::lround(times));
  shrink(factor, camera, mask);
  shrink(factor, camera, table);
}

}  // namespace

Eigen::Vector2d PinholeView::recorded_position(const Eigen::Vector2d& position) const {
  if (table_.empty()) return position;
  return source(table_, position.x(), position.y()).cast<double>();
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

void PinholeView::reduced(const Eigen::Vector2d& middle, const Eigen::Matrix2d& steps, float* values) const {
  constexpr int kSide = 2 * kBlock;
  float samples[kSide * kSide];
  patch(middle + steps * Eigen::Vector2d::Constant(0.25), 0.5 * steps).sample(-kBlock, kBlock - 1, samples);
  for (int row = 0; row < kBlock; ++row) {
    for (int column = 0; column < kBlock; ++column) {
      const float *const above = samples + 2 * (row * kSide + column), *const below = above + kSide;
      values[row * kBlock + column] = 0.25F * (above[0] + above[1] + below[0] + below[1]);
    }
  }
}

void PinholeView::Patch::sample(int first_step, int last_step, float* values) const {
  const int side = last_step - first_step + 1;
  const Eigen::Vector2d reach = std::max(-first_step, last_step) * steps_.cwiseAbs().rowwise().sum();
  const Eigen::Vector2d first = middle_ - reach, last = middle_ + reach;
  const bool is_inside = first.minCoeff() >= 0 && last.x() < recorded_.width - 1 && last.y() < recorded_.height - 1;
  for (int row = first_step; row <= last_step; ++row, values += side) {
    if (!is_inside || recorded_.max_value != kMaxValue8) {
      for (int column = 0; column < side; ++column) {
        const Eigen::Vector2d position = middle_ + steps_ * Eigen::Vector2d(first_step + column, row);
        values[column] = grey_at(recorded_, position.x(), position.y());
      }
      continue;
    }
    const Eigen::Vector2d of_row = row * steps_.col(1);
    const SampleRow samples{middle_.x(), middle_.y(), steps_(0, 0), steps_(1, 0), of_row.x(), of_row.y()};
    for (int column = 0; column < side; column += kColumns)
      sample_row(recorded_, samples, first_step + column, std::min(kColumns, side - column), values + column);
  }
}

StereoRig with_equal_scales(StereoRig rig) {
  const double ratio = focal_length(rig.left) / focal_length(rig.right);
  shrink_camera(ratio, rig.left, rig.left_undistortion, rig.left_mask);
  shrink_camera(1 / ratio, rig.right, rig.right_undistortion, rig.right_mask);
  return rig;
}

StereoRig with_scale_of(const PinholeCamera& camera, StereoRig rig) {
  const double ratio = focal_length(rig.left) / focal_length(camera);
  shrink_camera(ratio, rig.left, rig.left_undistortion, rig.left_mask);
  shrink_camera(ratio, rig.right, rig.right_undistortion, rig.right_mask);
  return rig;
}

Image undistort(const ImageView& recorded, const UndistortionTable& table) {
  Image image(table.width, table.height, recorded.max_value);
  for (std::size_t i = 0; i < table.source_x.size(); ++i) {
    const float value = bilinear(recorded.width, recorded.height, table.source_x[i], table.source_y[i],
                                 [&](int column, int row) { return static_cast<float>(recorded.value(column, row)); });
    const auto width = static_cast<std::size_t>(table.width);
    // Never negative, and rounded as the kernel rounds.
    image.set(static_cast<int>(i % width), static_cast<int>(i / width), static_cast<int>(value + 0.5f));  // NOLINT
  }
  return image;
}

}  // namespace quadedge
