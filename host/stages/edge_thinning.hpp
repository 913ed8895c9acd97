#pragma once
/// \file edge_thinning.hpp  Stage 2b: one edge per pixel along a curve; an optional pass over detected edges.

#include <map>
#include <string>

#include "opencl/kernel.hpp"
#include "stages/device_edges.hpp"
#include "stages/scan.hpp"

namespace quadedge::stages {

/// Thins the edges of images of one height: kernels/edge_thinning.cl. Enqueues only.
class EdgeThinning {
 public:
  /// `height` of the images [px]; at most max_edges edges. `variants`: stage "scan".
  EdgeThinning(opencl::Context& context, int height, int max_edges, const std::map<std::string, std::string>& variants);

  /// The edges of `all` that stay, in their order. What was cut off before counts as cut off.
  void run(const DeviceEdges& all, DeviceEdges& thinned);

 private:
  using In = opencl::In<cl_float>;
  using InInt = opencl::In<cl_int>;

  opencl::Context& context_;
  int height_, max_edges_;
  std::size_t local_size_;  ///< rows of the doubled grid per work-group
  Scan scan_;
  opencl::Buffer<cl_uchar> flags_;  ///< edges that stay
  opencl::Buffer<cl_int> counts_;   ///< of these per row of the doubled grid
  opencl::Kernel<In, cl_int, InInt, cl_int, opencl::Out<cl_uchar>, opencl::Out<cl_int>> choose_;
  opencl::Kernel<In, cl_int, InInt, cl_int, opencl::In<cl_uchar>, InInt, opencl::Out<cl_float>> move_;
};

}  // namespace quadedge::stages
