#pragma once
/// \file device_image.hpp  A grey image on the device.

#include <string>

#include "opencl/buffer.hpp"
#include "quadedge/image.hpp"

namespace quadedge::stages {

/// `others` and the defines of programs that read images with values up to `max_value`.
inline opencl::Defines image_defines(int max_value, opencl::Defines others = {}) {
  if (max_value != kMaxValue8) others["MAX_VALUE"] = std::to_string(max_value);
  return others;
}

/// Packed, height x width, pixels as in ImageView.
struct DeviceImage {
  opencl::Buffer<cl_uchar> pixels;
  int width = 0, height = 0;
};

}  // namespace quadedge::stages
