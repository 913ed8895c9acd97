/// \file common_view.cpp  Clips each pixel's ray, a line in homogeneous pixels, against the sides of the other image.
#include "edges/common_view.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <tbb/parallel_for.h>
#include <utility>

namespace quadedge::frontend {
namespace {

/// The points on a pixel's ray, as another camera sees them: far + nearness * near, homogeneous [px], nearness >= 0.
class OtherView {
 public:
  OtherView(const PinholeCamera& from, const PinholeCamera& to, const Eigen::Isometry3d& to_from_from)
      : far_(to.matrix() * to_from_from.linear() * from.matrix().inverse()),
        near_(to.matrix() * to_from_from.translation()) {
    inside_ << 1, 0, 0.5, -1, 0, to.width - 0.5, 0, 1, 0.5, 0, -1, to.height - 0.5, 0, 0, 1;
  }

  bool shows_at_infinity(double x, double y) const {
    return ((inside_ * far_ * Eigen::Vector3d(x, y, 1)).array() > 0).all();
  }
  /// Whether a point at some depth lies in the image.
  bool shows(double x, double y) const {
    const Sides at_infinity = inside_ * far_ * Eigen::Vector3d(x, y, 1), change = inside_ * near_;
    double least = 0, most = std::numeric_limits<double>::infinity();
    for (int side = 0; side < Sides::SizeAtCompileTime; ++side) {
      const double limit = -at_infinity[side] / change[side];
      if (change[side] > 0) least = std::max(least, limit);
      if (change[side] < 0) most = std::min(most, limit);
      if (change[side] == 0 && !(at_infinity[side] > 0)) return false;
    }
    return least <= most;
  }

 private:
  using Sides = Eigen::Matrix<double, 5, 1>;
  Eigen::Matrix3d far_;
  Eigen::Vector3d near_;
  Eigen::Matrix<double, 5, 3> inside_;  ///< positive for points in front of the camera and inside its image
};

PixelMask unseen(const PinholeCamera& camera, const OtherView& other) {
  const double right = camera.width - 1, bottom = camera.height - 1;
  if (other.shows_at_infinity(0, 0) && other.shows_at_infinity(right, 0) && other.shows_at_infinity(0, bottom) &&
      other.shows_at_infinity(right, bottom))
    return {};  // and so are all pixels between these
  const auto width = static_cast<std::size_t>(camera.width), height = static_cast<std::size_t>(camera.height);
  PixelMask mask{camera.width, camera.height, std::vector<std::uint8_t>(width * height)};
  tbb::parallel_for(std::size_t{0}, height, [&](std::size_t y) {
    for (std::size_t x = 0; x < width; ++x)
      mask.hidden[y * width + x] = other.shows(static_cast<double>(x), static_cast<double>(y)) ? 0 : 1;
  });
  return std::count(mask.hidden.begin(), mask.hidden.end(), 1) > 0 ? mask : PixelMask();
}

}  // namespace

PixelMask joined(PixelMask mask, const PixelMask& other) {
  if (mask.empty()) return other;
  if (other.empty()) return mask;
  for (std::size_t i = 0; i < mask.hidden.size(); ++i) mask.hidden[i] |= other.hidden[i];
  return mask;
}

StereoRig within_common_view(StereoRig rig) {
  const Eigen::Isometry3d left_from_right = rig.right_from_left.inverse();
  rig.left_mask =
      joined(std::move(rig.left_mask), unseen(rig.left, OtherView(rig.left, rig.right, rig.right_from_left)));
  rig.right_mask =
      joined(std::move(rig.right_mask), unseen(rig.right, OtherView(rig.right, rig.left, left_from_right)));
  return rig;
}

}  // namespace quadedge::frontend
