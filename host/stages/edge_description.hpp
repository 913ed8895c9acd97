#pragma once
/// \file edge_description.hpp  Stage 3: side patches and SIFT descriptors of the edges of one camera's image.

#include <map>
#include <string>

#include "opencl/kernel.hpp"
#include "quadedge/config.hpp"
#include "stages/device_edges.hpp"
#include "stages/pixel_corners.hpp"

namespace quadedge::stages {

/// Describes edges on the device. One object per camera: it keeps the prepared image until the next one, so that
/// patches can be cut anew at refined positions.
class EdgeDescription {
 public:
  /// For images of width x height pixels. Variants of the stages "patches" and "sift".
  EdgeDescription(opencl::Context& context, int width, int height, const PatchesConfig& patches, const SiftConfig& sift,
                  const std::map<std::string, std::string>& variants);

  /// Takes the next image (packed, height x width) for cut_patches(): prepares bilinear sampling.
  void prepare(const opencl::Buffer<cl_uchar>& image);
  /// Takes the next image for describe_sift(): prepares the gradient of the blurred image.
  void prepare_sift(const opencl::Buffer<cl_uchar>& image);

  /// Side patches at any `count` positions and directions in the prepared image.
  void cut_patches(const opencl::Buffer<cl_float>& x, const opencl::Buffer<cl_float>& y,
                   const opencl::Buffer<cl_float>& direction, int count, opencl::Buffer<cl_char>& patches);

  /// Side patches of the edges detected in the prepared image; after DeviceEdges::read_count().
  void cut_patches(const DeviceEdges& edges, opencl::Buffer<cl_char>& patches) {
    cut_patches(edges.x, edges.y, edges.direction, edges.host_count, patches);
  }

  /// SIFT descriptors of `count` edges of the prepared image: positions in pixels, directions in radians.
  void describe_sift(const opencl::Buffer<cl_float>& x, const opencl::Buffer<cl_float>& y,
                     const opencl::Buffer<cl_float>& direction, int count, opencl::Buffer<cl_uchar>& sift);

  void describe_sift(const DeviceEdges& edges, opencl::Buffer<cl_uchar>& sift) {
    describe_sift(edges.x, edges.y, edges.direction, edges.host_count, sift);
  }

  /// The prepared image for bilinear sampling.
  const PixelCorners& corners() const { return corners_; }

 private:
  template <class T>
  using In = opencl::In<T>;
  template <class T>
  using Out = opencl::Out<T>;

  void reserve_planes();

  opencl::Context& context_;
  int width_, height_;
  int stride_;  ///< floats per row of the planes of sift.cl
  float patch_offset_, sift_offset_;
  std::size_t patches_local_, patches_items_, sift_local_, sift_items_;  ///< group size; work-items per edge

  PixelCorners corners_;
  opencl::Buffer<cl_float> blurred_down_, blurred_;  ///< height x stride
  opencl::Buffer<cl_float> magnitude_, angle_;       ///< (height + 2 padding) x stride

  opencl::Kernel<In<cl_uint>, cl_int, cl_int, In<cl_float>, In<cl_float>, In<cl_float>, cl_int, cl_float, Out<cl_char>>
      patches_kernel_;
  opencl::Kernel<In<cl_uchar>, cl_int, cl_int, cl_int, Out<cl_float>> blur_down_kernel_;
  opencl::Kernel<In<cl_float>, cl_int, cl_int, Out<cl_float>> blur_along_kernel_;
  opencl::Kernel<In<cl_float>, cl_int, cl_int, cl_int, Out<cl_float>, Out<cl_float>> gradient_kernel_;
  opencl::Kernel<In<cl_float>, In<cl_float>, cl_int, cl_int, cl_int, In<cl_float>, In<cl_float>, In<cl_float>, cl_int,
                 cl_float, Out<cl_uchar>>
      sift_kernel_;
};

}  // namespace quadedge::stages
