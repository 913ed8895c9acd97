#pragma once
/// \file paper_patches.hpp  The picture that the paper's method samples, and both side patches of edges.

#include "device/device_edges.hpp"
#include "device/stage.hpp"
#include "quadedge/image.hpp"

namespace quadedge::stages {

/// Grey levels and slopes of an image: records of kernels/paper_sides.cl, 8 bytes per pixel, of more than 8 bits 16.
struct DevicePicture {
  opencl::Buffer<cl_uint> records;
  int width = 0, height = 0;
};

/// Cuts the side patches of the paper's method. One object per camera image: it holds the image's picture until the
/// next one. Variants of the stage "paper_patches".
class PaperPatches : private Stage {
 public:
  /// For images of width x height pixels with values to `max_value`.
  PaperPatches(opencl::Context& context, int width, int height, const opencl::VariantChoice& variants,
               int max_value = kMaxValue8);

  /// Takes the next image (packed, height x width).
  void prepare(const opencl::Buffer<cl_uchar>& image);

  /// Both patches of edges anywhere in the picture, their middles `offset` px from the edge: kPaperPatchFloats each.
  void cut(const PositionsView& edges, double offset, opencl::Buffer<cl_float>& patches);

  const DevicePicture& picture() const { return picture_; }
  /// Exchanges the picture with another one of this size, for example with that of the frame before.
  void swap(DevicePicture& picture) noexcept { std::swap(picture_, picture); }

 private:
  std::size_t words_per_record_;
  DevicePicture picture_;
  opencl::Kernel<void(const cl_uchar* bytes, cl_int width, cl_int height, cl_uint* records)> prepare_;
  opencl::Kernel<void(PatchArguments args, const cl_uint* records, const cl_float* positions, cl_float* patches)> cut_;
};

}  // namespace quadedge::stages
