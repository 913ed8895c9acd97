#pragma once
/// \file edge_descriptions.hpp  Stage 3: what describes an edge: side patches, SIFT, and wide descriptors for the
/// global matching.

#include "device/device_edges.hpp"
#include "device/images.hpp"
#include "device/stage.hpp"
#include "quadedge/config.hpp"
#include "quadedge/image.hpp"

namespace quadedge::stages {

/// Stage 3a.
/// Cuts side patches on the device. One object per camera: it holds the prepared image, so that patches can be cut
/// again at refined positions. Variants of the stage "patches".
class Patches : private Stage {
 public:
  /// For images of width x height pixels with values to `max_value`.
  Patches(opencl::Context& context, int width, int height, const PatchesConfig& config,
          const opencl::VariantChoice& variants, int max_value = kMaxValue8);

  /// Takes the next image (packed, height x width): prepares bilinear sampling.
  void prepare(const opencl::Buffer<cl_uchar>& image);

  /// Side patches of edges anywhere in the prepared image: kernels/patches.cl.
  void cut(const PositionsView& edges, opencl::Buffer<cl_char>& patches);
  /// The same of those edges that are `wanted` (not 0); the patches of the others are undefined.
  void cut(const PositionsView& edges, const opencl::Buffer<cl_int>& wanted, opencl::Buffer<cl_char>& patches);

  /// The prepared image for bilinear sampling.
  const PixelCorners& corners() const { return corners_; }

 private:
  void cut(const PositionsView& edges, bool all, const opencl::Buffer<cl_int>& wanted,
           opencl::Buffer<cl_char>& patches);

  int width_, height_;
  float offset_;
  PixelCorners corners_;
  opencl::Buffer<cl_int> unused_;  ///< in place of what is wanted, where all edges are
  opencl::Kernel<void(PatchArguments args, const cl_uint* corners, const cl_float* positions, const cl_int* wanted,
                      cl_char* patches)>
      kernel_;
};

/// Stage 3b, of both sides of an edge.
/// Describes edges by SIFT on the device. One object per camera: it keeps the prepared image until the next one.
/// Variants of the stage "sift".
class Sift : private Stage {
 public:
  /// For images of width x height pixels.
  Sift(opencl::Context& context, int width, int height, const opencl::VariantChoice& variants,
       int max_value = kMaxValue8);

  /// Takes the next image (packed, height x width): prepares the gradient of the blurred image.
  void prepare(const opencl::Buffer<cl_uchar>& image);

  /// Descriptors of edges of the prepared image: kernels/sift.cl.
  void describe(const PositionsView& edges, opencl::Buffer<cl_uchar>& descriptors);

 private:
  void reserve_planes();

  int width_, height_;
  int stride_;  ///< floats per row of the planes of sift.cl
  float offset_;
  opencl::Buffer<cl_float> blurred_down_, blurred_;  ///< height x stride
  opencl::Buffer<cl_float> magnitude_, angle_;       ///< (height + 2 padding) x stride
  opencl::Kernel<void(const cl_uchar* bytes, cl_int width, cl_int height, cl_int stride, cl_float* plane)> blur_down_;
  opencl::Kernel<void(const cl_float* plane, cl_int height, cl_int stride, cl_float* blurred)> blur_along_;
  opencl::Kernel<void(const cl_float* blurred, cl_int width, cl_int height, cl_int stride, cl_float* magnitude,
                      cl_float* angle)>
      gradient_;
  opencl::Kernel<void(SiftArguments args, const cl_float* magnitude, const cl_float* angle, const cl_float* positions,
                      cl_uchar* descriptors)>
      describe_;
};

/// Describes the surroundings of stereo edges, for the global matching: kernels/wide_description.cl.
/// Variants of the stage "wide_description".
class WideDescription : private Stage {
 public:
  /// For left images of width x height pixels.
  WideDescription(opencl::Context& context, int width, int height, const opencl::VariantChoice& variants,
                  int max_value = kMaxValue8);

  /// Prepares `image` (packed, height x width) for the description of edges.
  void prepare(const opencl::Buffer<cl_uchar>& image, opencl::Buffer<cl_float>& small);

  /// Descriptors of every step-th stereo edge, 128 bytes each. \returns how many.
  int describe(const opencl::Buffer<cl_float>& small, const DeviceStereoEdges& edges, int step,
               opencl::Buffer<cl_uchar>& descriptors);

 private:
  int width_, small_width_, small_height_;
  opencl::Kernel<void(const cl_uchar* bytes, cl_int width, cl_int small_width, cl_int small_height, cl_float* small)>
      shrink_;
  opencl::Kernel<void(const cl_float* small, cl_int small_width, cl_int small_height, const cl_float* edges,
                      cl_int stride, cl_int rows, cl_int step, cl_uchar* descriptors)>
      describe_;
};

}  // namespace quadedge::stages
