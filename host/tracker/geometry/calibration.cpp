/// \file calibration.cpp  Plausible ranges of camera numbers; the pinhole view of a lens and its table, pixel by pixel.
#include "geometry/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "common/printed.hpp"
#include "geometry/lens_mapping.hpp"
#include "quadedge/calibration.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/error.hpp"

namespace quadedge {
namespace {

constexpr double kShortestFocal = 0.01, kLongestFocal = 100, kFarthestCentre = 10;  // image sizes
constexpr double kLargestPixelRatio = 10;                                           // fx / fy
constexpr double kLargestSize = 65536;                                              // px, of any image

std::string number(double value) { return printed("%.9g", value); }

/// Beyond 60 degrees from the axis, a pinhole image is stretched by a factor of four or more.
constexpr double kWidestView = 120;  // degrees

/// The pinhole camera to which the images of a lens are resampled, with the same size and principal point.
PinholeCamera view_of(const Lens& lens, double fov) {
  PinholeCamera view = lens.camera;
  const double scale = LensMapping(lens).axial_scale();
  const double widest = 0.5 * view.width / std::tan(0.5 * (fov > 0 ? fov : kWidestView) * kDegree);
  if (fov == 0 && view.fx * scale >= widest) {
    view.fx *= scale;
    view.fy *= scale;
  } else {
    view.fy *= widest / view.fx;
    view.fx = widest;
  }
  return view;
}

/// Replacement for a direction that the lens does not show: the point of its rim on the same side. Used only for the
/// surroundings of visible pixels.
Eigen::Vector2d on_the_rim(const LensMapping& mapping, const Eigen::Vector3d& ray) {
  double inside = 0, outside = 1;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (inside + outside);
    (mapping.project({middle * ray.x(), middle * ray.y(), ray.z()}) ? inside : outside) = middle;
  }
  return mapping.project({inside * ray.x(), inside * ray.y(), ray.z()}).value_or(Eigen::Vector2d::Zero());
}

/// Fills the table of a view, and its mask if some pixels are not visible in the recorded image.
void add_table(const Lens& lens, const PinholeCamera& view, UndistortionTable& table, PixelMask& mask) {
  const LensMapping mapping(lens);
  const auto pixels = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
  std::vector<float> source_x(pixels), source_y(pixels);
  mask = {view.width, view.height, std::vector<std::uint8_t>(pixels)};
  std::size_t at = 0;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x, ++at) {
      const Eigen::Vector3d ray = view.ray(Eigen::Vector2d(x, y));
      const auto seen = mapping.project(ray);
      const Eigen::Vector2d place = seen ? *seen : on_the_rim(mapping, ray);
      source_x[at] = static_cast<float>(place.x());
      source_y[at] = static_cast<float>(place.y());
      const bool recorded = seen && place.x() >= 0 && place.y() >= 0 && place.x() <= lens.camera.width - 1 &&
                            place.y() <= lens.camera.height - 1;
      mask.hidden[at] = recorded ? 0 : 1;
    }
  }
  table = {view.width, view.height, std::move(source_x), std::move(source_y), lens.camera.width, lens.camera.height};
  if (std::count(mask.hidden.begin(), mask.hidden.end(), 1) == 0) mask = {};
}

}  // namespace

double rotation_error(const Eigen::Matrix3d& matrix) {
  if (!matrix.allFinite() || matrix.determinant() < 0) return std::numeric_limits<double>::infinity();
  return (matrix.transpose() * matrix - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

bool is_affine(const Eigen::Isometry3d& transform) {
  return transform.matrix().row(3) == Eigen::RowVector4d(0, 0, 0, 1);
}

std::optional<CameraComplaint> complaint_about(const PinholeCamera& camera) {
  const bool is_known = camera.width > 0 && camera.height > 0;
  const double size = is_known ? std::max(camera.width, camera.height) : kLargestSize;
  const double low = is_known ? kShortestFocal * size : kShortestFocal, high = kLongestFocal * size;
  for (const auto& [name, value] : {std::pair("fx", camera.fx), {"fy", camera.fy}}) {
    if (!(value >= low && value <= high))
      return CameraComplaint{std::string("a focal length ") + name + " of " + number(value),
                             "a positive number of pixels, from " + number(low) + " to " + number(high)};
  }
  if (const double ratio = camera.fx / camera.fy; ratio < 1 / kLargestPixelRatio || ratio > kLargestPixelRatio)
    return CameraComplaint{"focal lengths of " + number(camera.fx) + " and " + number(camera.fy),
                           "fx and fy of about the same size"};
  for (const auto& [name, value] : {std::pair("cx", camera.cx), {"cy", camera.cy}}) {
    const double farthest = kFarthestCentre * size;
    if (!(value >= -farthest && value <= farthest))
      return CameraComplaint{std::string("a principal point ") + name + " of " + number(value),
                             "a finite number of pixels, from " + number(-farthest) + " to " + number(farthest)};
  }
  return std::nullopt;
}

StereoRig make_rig(const StereoCalibration& calibration, double fov) {
  if (!(fov >= 0 && fov < 180))
    throw UsageError("--fov " + printed("%f", fov) + ": expected degrees above 0 and below 180");
  const auto see = [&](const Lens& lens, PinholeCamera& camera, UndistortionTable& table, PixelMask& mask) {
    if (lens.camera.width <= 0 || lens.camera.height <= 0)
      throw DataError(calibration.files + ": the size of the recorded images is missing, expected columns and rows");
    camera = view_of(lens, fov);
    const bool unchanged = lens.is_pinhole() && camera.fx == lens.camera.fx;
    if (!unchanged) add_table(lens, camera, table, mask);
  };
  StereoRig rig;
  see(calibration.left, rig.left, rig.left_undistortion, rig.left_mask);
  see(calibration.right, rig.right, rig.right_undistortion, rig.right_mask);
  rig.right_from_left = calibration.right_from_left;
  return rig;
}

StereoCalibration pinhole_calibration(const StereoRig& rig) {
  StereoCalibration calibration;
  calibration.left.camera = rig.left;
  calibration.right.camera = rig.right;
  calibration.right_from_left = rig.right_from_left;
  return calibration;
}

}  // namespace quadedge
