#pragma once
/// \file pinhole_view.hpp  A recorded image as its pinhole camera would have seen it, one sample at a time.

#include <Eigen/Core>

#include "quadedge/camera.hpp"
#include "quadedge/image.hpp"

namespace quadedge::odometry {

/// Looks into a recorded image through its undistortion table, for the few places that are wanted on the host.
class PinholeView {
 public:
  /// Refers to the image and the table, which must outlive it. `table` may be empty.
  PinholeView(const ImageView& recorded, const UndistortionTable& table, const PinholeCamera& camera)
      : recorded_(recorded), table_(table), width_(camera.width), height_(camera.height) {}

  int width() const { return width_; }
  int height() const { return height_; }
  /// Is a square of half the side `reach` around a position within the image?
  bool holds(const Eigen::Vector2d& at, double reach) const {
    return at.x() >= reach && at.y() >= reach && at.x() <= width_ - 1 - reach && at.y() <= height_ - 1 - reach;
  }
  /// Grey level at a position, bilinear; what lies outside is replicated from the border. [px]
  float at(double x, double y) const;
  /// What is seen around a position: grey levels at `position + steps * (column, row)`. Over a patch the lens is taken
  /// as affine; a sample 6 px from the middle of EuRoC's moves by 0.03 px at most for that, in both cameras alike.
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
  /// The samples of columns and rows -half to half, row-major.
  void sample(int half, float* values) const;

 private:
  friend class PinholeView;
  Patch(const ImageView& recorded, const Eigen::Vector2d& middle, const Eigen::Matrix2d& steps)
      : recorded_(recorded), middle_(middle), steps_(steps) {}

  const ImageView& recorded_;
  Eigen::Vector2d middle_;  ///< in the recorded image
  Eigen::Matrix2d steps_;   ///< recorded pixels per column and row
};

}  // namespace quadedge::odometry
