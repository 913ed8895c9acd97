#pragma once
/// \file device_image.hpp  A grey image on the device.

#include "opencl/buffer.hpp"

namespace quadedge::stages {

/// Packed, height x width.
struct DeviceImage {
  opencl::Buffer<cl_uchar> pixels;
  int width = 0, height = 0;
};

}  // namespace quadedge::stages
