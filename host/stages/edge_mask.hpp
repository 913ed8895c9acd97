#pragma once
/// \file edge_mask.hpp  Between stages 2b and 2c: no edges where an image shows nothing of the world. doc/method.md
/// section 1.

#include "opencl/kernel.hpp"
#include "quadedge/camera.hpp"
#include "stages/edge_maxima.hpp"

namespace quadedge::stages {

/// Removes the maxima of one camera's images within edges.margin of hidden pixels. Does nothing without a mask.
class EdgeMask {
 public:
  /// \param margin edges.margin [px]
  /// \param maxima the argument of later calls of run()
  EdgeMask(opencl::Context& context, const PixelMask& mask, int margin, const EdgeMaxima& maxima);

  /// Enqueues only.
  void run(EdgeMaxima& maxima);

 private:
  opencl::Context& context_;
  int width_, height_;
  std::size_t local_size_;
  opencl::Buffer<cl_uchar> hidden_;  ///< empty: no mask
  opencl::Kernel<cl_int, cl_int, opencl::In<cl_uchar>, opencl::Out<cl_float>, opencl::Out<cl_int>> rows_;
  opencl::Kernel<cl_int, opencl::In<cl_uchar>, opencl::Out<cl_uchar>> pixels_;
};

}  // namespace quadedge::stages
