#pragma once
/// \file undistortion.hpp  Recorded images as seen by their pinhole cameras: whole ones, samples of single positions,
/// and cameras of equal scale.

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/image.hpp"

namespace quadedge {

/// The pinhole image (table.height x table.width) of a recorded image: bilinear, border replicated, rounded half up.
/// Plain C++ twin of kernels/undistortion.cl.
Image undistort(const ImageView& recorded, const UndistortionTable& table);

/// Bilinear interpolation of value(column, row) over a grid of width x height, whose border is replicated; NaN counts
/// as 0.
template <class Value>
auto bilinear(int width, int height, double x, double y, const Value& value) -> decltype(value(0, 0)) {
  x = std::max(0.0, std::min(x, width - 1.0));  // in this order, NaN becomes 0
  y = std::max(0.0, std::min(y, height - 1.0));
  const int x0 = std::min(static_cast<int>(x), std::max(width - 2, 0)),
            y0 = std::min(static_cast<int>(y), std::max(height - 2, 0));
  const int x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
  const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
  const decltype(value(0, 0)) above = (1 - fx) * value(x0, y0) + fx * value(x1, y0);
  const decltype(value(0, 0)) below = (1 - fx) * value(x0, y1) + fx * value(x1, y1);
  return (1 - fy) * above + fy * below;
}

/// Position in the recorded image that a table has for a position in the pinhole camera's.
inline Eigen::Array2f source(const UndistortionTable& table, double x, double y) {
  return bilinear(table.width, table.height, x, y, [&](int column, int row) {
    const std::size_t i =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(table.width) + static_cast<std::size_t>(column);
    return Eigen::Array2f(table.source_x[i], table.source_y[i]);
  });
}

/// Samples a recorded image through its undistortion table at individual positions, on the host.
class PinholeView {
 public:
  /// Refers to the image and the table, which must outlive the object. `table` may be empty.
  PinholeView(const ImageView& recorded, const UndistortionTable& table, const PinholeCamera& camera)
      : recorded_(recorded), table_(table), width_(camera.width), height_(camera.height) {}

  int width() const { return width_; }
  int height() const { return height_; }
  /// Whether the square of half side `reach` around a position lies within the image.
  bool holds(const Eigen::Vector2d& at, double reach) const {
    return at.x() >= reach && at.y() >= reach && at.x() <= width_ - 1 - reach && at.y() <= height_ - 1 - reach;
  }
  /// Grey level at a position [px], bilinear; the border is replicated.
  float at(double x, double y) const;
  /// Grey levels around a position, at `position + steps * (column, row)`. The lens mapping is approximated as affine
  /// within a patch; for EuRoC, this displaces a sample 6 px from the centre by at most 0.03 px, equally in both
  /// cameras.
  class Patch;
  Patch patch(const Eigen::Vector2d& position, const Eigen::Matrix2d& steps) const;
  static constexpr int kBlock = 8;  ///< side of a block of reduced pixels
  /// Grey levels of kBlock x kBlock reduced pixels, row-major: each the mean of four positions half a pixel apart.
  /// \param middle of the block \param steps from a reduced pixel to the next column and row
  void reduced(const Eigen::Vector2d& middle, const Eigen::Matrix2d& steps, float* values) const;

 private:
  Eigen::Vector2d recorded_position(const Eigen::Vector2d& position) const;

  ImageView recorded_;
  const UndistortionTable& table_;
  int width_, height_;
};

class PinholeView::Patch {
 public:
  /// Samples columns and rows `first` to `last`, row-major.
  void sample(int first, int last, float* values) const;

 private:
  friend class PinholeView;
  Patch(const ImageView& recorded, const Eigen::Vector2d& middle, const Eigen::Matrix2d& steps)
      : recorded_(recorded), middle_(middle), steps_(steps) {}

  const ImageView& recorded_;
  Eigen::Vector2d middle_;  ///< in the recorded image
  Eigen::Matrix2d steps_;   ///< recorded pixels per column and row
};

/// Edges and patches have a fixed scale in pixels. If the focal length in pixels of one camera is at least one and a
/// half times that of the other, their patches cover different parts of the scene. Such a camera is reduced to a half,
/// a third ... of its resolution; its undistortion table samples the recorded image at the pixel centres, which for a
/// half is the mean of four pixels. Other rigs are returned unchanged.
StereoRig with_equal_scales(StereoRig rig);

/// Reduces both cameras of such a rig in the same way if their focal length is at least one and a half times that of
/// another camera, with whose edges theirs are to be matched.
StereoRig with_scale_of(const PinholeCamera& camera, StereoRig rig);

}  // namespace quadedge
