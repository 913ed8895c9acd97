#pragma once
/// \file sift.hpp  Stage 3b: SIFT descriptors of both sides of the edges of one camera's image.

#include <map>
#include <string>

#include "opencl/argument_structs.hpp"
#include "quadedge/config.hpp"
#include "quadedge/image.hpp"
#include "stages/packed_positions.hpp"

namespace quadedge::stages {

/// Describes edges by SIFT on the device. One object per camera: it keeps the prepared image until the next one.
/// Variants of the stage "sift".
class Sift {
 public:
  /// For images of width x height pixels.
  Sift(opencl::Context& context, int width, int height, const SiftConfig& config,
       const std::map<std::string, std::string>& variants, int max_value = kMaxValue8);

  /// Takes the next image (packed, height x width): prepares the gradient of the blurred image.
  void prepare(const opencl::Buffer<cl_uchar>& image);

  /// Descriptors of edges of the prepared image: kernels/sift.cl.
  void describe(const PositionsView& edges, opencl::Buffer<cl_uchar>& descriptors);

 private:
  template <class T>
  using In = opencl::In<T>;
  template <class T>
  using Out = opencl::Out<T>;

  void reserve_planes();

  opencl::Context& context_;
  int width_, height_;
  int stride_;  ///< floats per row of the planes of sift.cl
  float offset_;
  std::size_t local_size_, items_per_edge_;
  opencl::Buffer<cl_float> blurred_down_, blurred_;  ///< height x stride
  opencl::Buffer<cl_float> magnitude_, angle_;       ///< (height + 2 padding) x stride
  opencl::Kernel<In<cl_uchar>, cl_int, cl_int, cl_int, Out<cl_float>> blur_down_;
  opencl::Kernel<In<cl_float>, cl_int, cl_int, Out<cl_float>> blur_along_;
  opencl::Kernel<In<cl_float>, cl_int, cl_int, cl_int, Out<cl_float>, Out<cl_float>> gradient_;
  opencl::Kernel<SiftArguments, In<cl_float>, In<cl_float>, In<cl_float>, Out<cl_uchar>> describe_;
};

}  // namespace quadedge::stages
