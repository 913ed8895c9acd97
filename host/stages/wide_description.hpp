#pragma once
/// \file wide_description.hpp  Descriptors of the surroundings of stereo edges, for global matching:
/// kernels/wide_description.cl.

#include <map>
#include <string>

#include "opencl/kernel.hpp"
#include "stages/device_stereo_edges.hpp"

namespace quadedge::stages {

/// Variants of the stage "wide_description".
class WideDescription {
 public:
  /// For left images of width x height pixels.
  WideDescription(opencl::Context& context, int width, int height, const std::map<std::string, std::string>& variants,
                  int max_value = kMaxValue8);

  /// Prepares `image` (packed, height x width) for the description of edges.
  void prepare(const opencl::Buffer<cl_uchar>& image, opencl::Buffer<cl_float>& small);

  /// Descriptors of every step-th stereo edge, 128 bytes each. \returns how many.
  int describe(const opencl::Buffer<cl_float>& small, const DeviceStereoEdges& edges, int step,
               opencl::Buffer<cl_uchar>& descriptors);

 private:
  template <class T>
  using In = opencl::In<T>;
  template <class T>
  using Out = opencl::Out<T>;

  opencl::Context& context_;
  int width_, small_width_, small_height_;
  std::size_t local_size_, items_per_row_;
  opencl::Kernel<In<cl_uchar>, cl_int, cl_int, cl_int, Out<cl_float>> shrink_;
  opencl::Kernel<In<cl_float>, cl_int, cl_int, In<cl_float>, cl_int, cl_int, cl_int, Out<cl_uchar>> describe_;
};

}  // namespace quadedge::stages
