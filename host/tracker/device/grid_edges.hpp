#pragma once
/// \file grid_edges.hpp  Edges of the paper's method: kernels/grid_edges.cl. doc/paper.md.

#include "device/device_edges.hpp"
#include "device/images.hpp"
#include "device/stage.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge::stages {

/// Third-order edges on the grid of two samples per pixel and axis, in images of one size. Only enqueues commands.
/// Variants of the stage "grid_edges".
class GridEdges : private Stage {
 public:
  /// \param mask of the camera: no edges within config.margin of hidden pixels; may be empty \throws UsageError for an
  /// unknown variant
  GridEdges(opencl::Context& context, int width, int height, const EdgesConfig& config, const PixelMask& mask,
            const opencl::VariantChoice& variants);

  /// Replaces the mask, between frames.
  void set_mask(const PixelMask& mask);

  /// Edges in the image of `plane` above `threshold` (one float on the device, grey levels per px), sorted by the pixel
  /// that they lie in, row by row, and then by x. At most config.max_edges are stored; the rest is counted in
  /// `edges.count`. Call edges.read_count() before the number is needed on the host.
  void run(const PaddedPlane& plane, const opencl::Buffer<cl_float>& threshold, DeviceEdges& edges);

 private:
  std::size_t strips() const { return static_cast<std::size_t>((2 * height_ + strip_rows_ - 1) / strip_rows_); }

  int width_, height_;
  EdgesConfig config_;
  int strip_rows_;  ///< of the grid, per work-item
  int line_;        ///< floats of a line of scratch memory
  bool masked_ = false;
  Scan scan_;
  opencl::Buffer<cl_float> taps_, scratch_, found_;
  opencl::Buffer<cl_int> counts_, of_rows_;
  opencl::Buffer<cl_uchar> hidden_;
  opencl::Kernel<void(DetectionArguments args, const cl_float* threshold_of_frame, const cl_float* plane,
                      const cl_float* taps, const cl_uchar* hidden, cl_int masked, cl_float* scratch, cl_int line,
                      cl_float* found, cl_int* counts)>
      strips_;
  opencl::Kernel<void(cl_int height, const cl_int* counts, cl_int* of_rows)> count_;
  opencl::Kernel<void(DetectionArguments args, const cl_float* found, const cl_int* counts, const cl_int* row_first,
                      cl_float* edges)>
      merge_;
};

}  // namespace quadedge::stages
