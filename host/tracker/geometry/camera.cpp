/// \file camera.cpp  Validates cameras, their scales, the relative pose, and tables and masks of the images' size.
#include "quadedge/camera.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/printed.hpp"
#include "geometry/calibration.hpp"
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

/// Whether something of this size for every pixel, such as a table or a mask, fits the camera. None fits any camera.
template <class T>
bool fits(int width, int height, const std::vector<T>& values, const PinholeCamera& camera) {
  if (width == 0 && height == 0 && values.empty()) return true;
  return width == camera.width && height == camera.height &&
         values.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

[[noreturn]] void refuse(const std::string& where, const std::string& what, int width, int height, std::size_t values,
                         const PinholeCamera& camera) {
  throw DataError(where + ": found " + what + " of " + std::to_string(width) + " x " + std::to_string(height) +
                  " with " + std::to_string(values) + " values, expected " + std::to_string(camera.width) + " x " +
                  std::to_string(camera.height) + " with a value for each pixel");
}

void check_table(const UndistortionTable& table, const PinholeCamera& camera, const std::string& where) {
  for (const SharedFloats& shared : {table.source_x, table.source_y}) {
    const std::vector<float>& values = shared.values();
    if (!fits(table.width, table.height, values, camera))
      refuse(where, "an undistortion table", table.width, table.height, values.size(), camera);
    if (!std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); }))
      throw DataError(where + ": found an undistortion table with NaN or infinity, expected finite numbers");
  }
  if (table.recorded_width < 0 || table.recorded_height < 0)
    throw DataError(where + ": found recorded images of " + std::to_string(table.recorded_width) + " x " +
                    std::to_string(table.recorded_height) + ", expected positive numbers, or 0 for any size");
}

void check_mask(const PixelMask& mask, const PinholeCamera& camera, const std::string& where) {
  if (!fits(mask.width, mask.height, mask.hidden, camera))
    refuse(where, "a mask", mask.width, mask.height, mask.hidden.size(), camera);
}

}  // namespace

double StereoRig::disparity_range() const {
  return max_disparity > 0 ? max_disparity : left.fx * baseline() / kNearestDepth;
}

void check_rig(const StereoRig& rig, const char* source) {
  const std::string where(source);
  check_camera(rig.left, where + " (left camera)");
  check_camera(rig.right, where + " (right camera)");
  constexpr int kLargestScaleRatio = 16;  // a camera of a higher resolution is reduced by this factor
  const double ratio = rig.left.fx / rig.right.fx;
  if (ratio > kLargestScaleRatio || ratio < 1.0 / kLargestScaleRatio) {
    throw DataError(where + ": found focal lengths fx of " + printed("%f", rig.left.fx) + " (left) and " +
                    printed("%f", rig.right.fx) + " px (right), expected a ratio of at most " +
                    std::to_string(kLargestScaleRatio));
  }
  const Eigen::Matrix3d rotation = rig.right_from_left.linear();
  const double deviation = rotation_error(rotation);
  if (deviation > kRotationTolerance || !is_affine(rig.right_from_left)) {
    throw DataError(where + ": found a rotation right_from_left that deviates from an orthonormal one by " +
                    printed("%f", deviation) + " (determinant " + printed("%f", rotation.determinant()) +
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
