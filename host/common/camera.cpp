#include "quadedge/camera.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "common/calibration.hpp"
#include "quadedge/error.hpp"

namespace quadedge {
namespace {

/// Nearest objects in front of a handheld camera or a small robot.
constexpr double kNearestDepth = 0.5;  // m

void check_camera(const PinholeCamera& camera, const std::string& where) {
  for (const auto& [name, side] : {std::pair("width", camera.width), {"height", camera.height}}) {
    if (side <= 0)
      throw DataError(where + ": found image " + name + " " + std::to_string(side) +
                      ", expected a positive number of pixels");
  }
  if (const auto complaint = complaint_about(camera))
    throw DataError(where + ": found " + complaint->found + ", expected " + complaint->expected);
}

void check_table(const UndistortionTable& table, const PinholeCamera& camera, const std::string& where) {
  if (table.empty()) return;
  const std::size_t expected = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  if (table.width != camera.width || table.height != camera.height || table.source_x.size() != expected ||
      table.source_y.size() != expected) {
    throw DataError(where + ": found an undistortion table of " + std::to_string(table.width) + " x " +
                    std::to_string(table.height) + ", expected " + std::to_string(camera.width) + " x " +
                    std::to_string(camera.height));
  }
}

void check_mask(const PixelMask& mask, const PinholeCamera& camera, const std::string& where) {
  const std::size_t expected = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  if (mask.empty() || (mask.width == camera.width && mask.height == camera.height && mask.hidden.size() == expected))
    return;
  throw DataError(where + ": found a mask of " + std::to_string(mask.width) + " x " + std::to_string(mask.height) +
                  ", expected " + std::to_string(camera.width) + " x " + std::to_string(camera.height));
}

}  // namespace

double StereoRig::disparity_range() const {
  return max_disparity > 0 ? max_disparity : left.fx * baseline() / kNearestDepth;
}

void check_rig(const StereoRig& rig, const char* source) {
  /// Largest permitted entry of R^T R - I. Readers project the stored matrix onto the rotations, so that only rounding
  /// remains.
  constexpr double kRotationTolerance = 1e-6;
  const std::string where(source);
  check_camera(rig.left, where + " (left camera)");
  check_camera(rig.right, where + " (right camera)");
  constexpr int kLargestScaleRatio = 16;  // a camera of a higher resolution is reduced by this factor
  const double ratio = rig.left.fx / rig.right.fx;
  if (ratio > kLargestScaleRatio || ratio < 1.0 / kLargestScaleRatio) {
    throw DataError(where + ": found focal lengths fx of " + std::to_string(rig.left.fx) + " (left) and " +
                    std::to_string(rig.right.fx) + " px (right), expected a ratio of at most " +
                    std::to_string(kLargestScaleRatio));
  }
  const Eigen::Matrix3d rotation = rig.right_from_left.linear();
  const double deviation = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation <= kRotationTolerance) || rotation.determinant() < 0) {
    throw DataError(where + ": found a rotation right_from_left that deviates from an orthonormal one by " +
                    std::to_string(deviation) + " (determinant " + std::to_string(rotation.determinant()) +
                    "), expected a right-handed orthonormal matrix");
  }
  if (!std::isfinite(rig.baseline()) || rig.baseline() <= 0) {
    throw DataError(where + ": found a baseline of " + std::to_string(rig.baseline()) +
                    " m, expected a finite positive length");
  }
  if (!(rig.max_disparity >= 0 && std::isfinite(rig.max_disparity))) {
    throw DataError(where + ": found a maximum disparity of " + std::to_string(rig.max_disparity) +
                    " px, expected a finite number, or 0 if it is unknown");
  }
  check_table(rig.left_undistortion, rig.left, where + " (left camera)");
  check_table(rig.right_undistortion, rig.right, where + " (right camera)");
  check_mask(rig.left_mask, rig.left, where + " (left camera)");
  check_mask(rig.right_mask, rig.right, where + " (right camera)");
}

}  // namespace quadedge
