#pragma once
/// \file patches.hpp  Stage 3a: side patches of the edges of one camera's image.

#include <map>
#include <string>

#include "opencl/argument_structs.hpp"
#include "quadedge/config.hpp"
#include "stages/packed_positions.hpp"
#include "stages/pixel_corners.hpp"

namespace quadedge::stages {

/// Cuts side patches on the device. One object per camera: it holds the prepared image, so that patches can be cut
/// again at refined positions. Variants of the stage "patches".
class Patches {
 public:
  /// For images of width x height pixels with values to `max_value`.
  Patches(opencl::Context& context, int width, int height, const PatchesConfig& config,
          const std::map<std::string, std::string>& variants, int max_value = kMaxValue8);

  /// Takes the next image (packed, height x width): prepares bilinear sampling.
  void prepare(const opencl::Buffer<cl_uchar>& image);

  /// Side patches of edges anywhere in the prepared image: kernels/patches.cl.
  void cut(const PositionsView& edges, opencl::Buffer<cl_char>& patches);
  /// The same of those edges that are `wanted` (not 0); the patches of the others are undefined.
  void cut(const PositionsView& edges, const opencl::Buffer<cl_int>& wanted, opencl::Buffer<cl_char>& patches);

  /// The prepared image for bilinear sampling.
  const PixelCorners& corners() const { return corners_; }

 private:
  template <class T>
  using In = opencl::In<T>;

  void cut(const PositionsView& edges, bool all, const opencl::Buffer<cl_int>& wanted,
           opencl::Buffer<cl_char>& patches);

  opencl::Context& context_;
  int width_, height_;
  float offset_;
  std::size_t local_size_, items_per_edge_;
  PixelCorners corners_;
  opencl::Buffer<cl_int> unused_;  ///< in place of what is wanted, where all edges are
  opencl::Kernel<PatchArguments, In<cl_uint>, In<cl_float>, In<cl_int>, opencl::Out<cl_char>> kernel_;
};

}  // namespace quadedge::stages
