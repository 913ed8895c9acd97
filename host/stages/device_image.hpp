#pragma once
/// \file device_image.hpp  A grey image on the device.

#include <string>

#include "opencl/buffer.hpp"
#include "quadedge/image.hpp"

namespace quadedge::stages {

/// The defines of programs that read images whose largest value is `white`, on top of others.
inline opencl::Defines image_defines(int white, opencl::Defines others = {}) {
  if (white != kWhite8) others["WHITE"] = std::to_string(white);
  return others;
}

/// Packed, height x width, pixels as in ImageView.
struct DeviceImage {
  opencl::Buffer<cl_uchar> pixels;
  int width = 0, height = 0;
};

}  // namespace quadedge::stages
