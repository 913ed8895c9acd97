#pragma once
/// \file edge_maxima.hpp  What the maximum test leaves of an image, before its edges get their third-order direction.

#include "opencl/buffer.hpp"
#include "opencl/context.hpp"

namespace quadedge::stages {

/// The maxima of one image on the device.
struct EdgeMaxima {
  /// 4 floats per maximum: x, y [px], strength [grey levels per px], column of the doubled grid + direction code
  /// (kernels/edge_detection.cl). Room for every cell.
  opencl::Buffer<cl_float> winners;
  opencl::Buffer<cl_int> counts;   ///< maxima per row of the doubled grid
  opencl::Buffer<cl_uchar> flags;  ///< 1 for cells that are maxima; only with `in_cells`
  bool in_cells =
      false;  ///< maxima are stored at the position of their cell and marked in `flags`; otherwise rows are packed

  /// Defines of the kernels that thin out the maxima.
  opencl::Defines defines() const { return in_cells ? opencl::Defines{{"IN_CELLS", "1"}} : opencl::Defines{}; }
};

}  // namespace quadedge::stages
