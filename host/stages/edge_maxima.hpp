#pragma once
/// \file edge_maxima.hpp  What the maximum test leaves of an image, before its edges get their third-order direction.

#include "opencl/buffer.hpp"
#include "opencl/context.hpp"

namespace quadedge::stages {

/// The maxima of one image on the device.
struct EdgeMaxima {
  /// 4 floats per maximum: x, y [px], column of the pixel, direction code (kernels/edge_detection.cl). Room for every
  /// pixel and kMaximaAtOnce more.
  opencl::Buffer<cl_float> winners;
  opencl::Buffer<cl_int> counts;   ///< maxima per row
  opencl::Buffer<cl_uchar> flags;  ///< 1 for pixels that are maxima; only with `at_pixels`
  bool at_pixels =
      false;  ///< maxima are stored at the position of their pixel and marked in `flags`; otherwise rows are packed

  /// Defines of the kernels that thin out the maxima.
  opencl::Defines defines() const { return at_pixels ? opencl::Defines{{"AT_PIXELS", "1"}} : opencl::Defines{}; }
};

}  // namespace quadedge::stages
