#include "quadedge/camera.hpp"

#include <cmath>
#include <string>

#include "quadedge/error.hpp"

namespace quadedge {
namespace {

/// Nearest objects in front of a handheld camera or a small robot.
constexpr double kNearestDepth = 0.5;  // m

void check_camera(const PinholeCamera& camera, const std::string& where) {
  const auto require = [&](bool good, const char* what, double value, const char* expected) {
    if (!good) throw DataError(where + ": found " + what + " " + std::to_string(value) + ", expected " + expected);
  };
  require(std::isfinite(camera.fx) && camera.fx > 0, "focal length fx", camera.fx, "a positive number of pixels");
  require(std::isfinite(camera.fy) && camera.fy > 0, "focal length fy", camera.fy, "a positive number of pixels");
  require(std::isfinite(camera.cx), "principal point cx", camera.cx, "a finite number of pixels");
  require(std::isfinite(camera.cy), "principal point cy", camera.cy, "a finite number of pixels");
  require(camera.width > 0, "image width", camera.width, "a positive number of pixels");
  require(camera.height > 0, "image height", camera.height, "a positive number of pixels");
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
