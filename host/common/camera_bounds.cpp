#include "common/camera_bounds.hpp"

#include <algorithm>
#include <cstdio>

namespace quadedge {
namespace {

constexpr double kShortestFocal = 0.01, kLongestFocal = 100, kFarthestCentre = 10;  // image sizes
constexpr double kLargestPixelRatio = 10;                                           // fx / fy
constexpr double kLargestSize = 65536;                                              // px, of any image

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

}  // namespace

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

}  // namespace quadedge
