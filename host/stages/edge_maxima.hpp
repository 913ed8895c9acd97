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
  opencl::Buffer<cl_uchar> flags;  ///< 1 where a cell is a maximum; with `in_cells` alone
  bool in_cells = false;  ///< winners stand at their cell's position, and `flags` says where; else packed in each row

  /// What the kernels that thin out the maxima are built with.
  opencl::Defines defines() const { return in_cells ? opencl::Defines{{"IN_CELLS", "1"}} : opencl::Defines{}; }
};

}  // namespace quadedge::stages
