#pragma once
/// \file pinhole_view.hpp  Samples a recorded image as seen by its pinhole camera.

#include <Eigen/Core>

#include "quadedge/camera.hpp"
#include "quadedge/image.hpp"

namespace quadedge {

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

 private:
  Eigen::Vector2d recorded_position(const Eigen::Vector2d& position) const;

  ImageView recorded_;
  const UndistortionTable& table_;
  int width_, height_;
};

class PinholeView::Patch {
 public:
  /// Samples columns and rows -half to half, row-major.
  void sample(int half, float* values) const;

 private:
  friend class PinholeView;
  Patch(const ImageView& recorded, const Eigen::Vector2d& middle, const Eigen::Matrix2d& steps)
      : recorded_(recorded), middle_(middle), steps_(steps) {}

  const ImageView& recorded_;
  Eigen::Vector2d middle_;  ///< in the recorded image
  Eigen::Matrix2d steps_;   ///< recorded pixels per column and row
};

}  // namespace quadedge
