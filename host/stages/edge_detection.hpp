#pragma once
/// \file edge_detection.hpp  Stage 2b: third-order edges of one image on the device. doc/method.md section 1.

#include <map>
#include <string>

#include "opencl/argument_structs.hpp"
#include "quadedge/config.hpp"
#include "stages/device_edges.hpp"
#include "stages/edge_maxima.hpp"
#include "stages/padded_plane.hpp"
#include "stages/scan.hpp"

namespace quadedge::stages {

/// Detects edges in images of one size. Owns its kernels and scratch memory and only enqueues commands, so that it can
/// be used for one image after another. All variants give the same bytes.
class EdgeDetection {
 public:
  /// `variants`: stage "edge_detection" (strip, tile...) and stage "scan". \throws UsageError for an unknown variant or
  /// an empty image, DeviceError when the kernels do not build.
  EdgeDetection(opencl::Context& context, int width, int height, const EdgesConfig& config,
                const std::map<std::string, std::string>& variants);

  /// Enqueues the detection in the image of `plane`, above `threshold` (one float on the device, grey levels per px).
  /// At most config.max_edges edges are stored; the rest, at the end of the scan order, is counted in `edges.count`.
  /// Call edges.read_count() before the number is needed on the host.
  void run(const PaddedPlane& plane, const opencl::Buffer<cl_float>& threshold, DeviceEdges& edges);

  /// The first half of run(): the maxima of the gradient.
  void find_maxima(const PaddedPlane& plane, const opencl::Buffer<cl_float>& threshold);
  /// The result of the first half. A selection can remove maxima before the second half.
  EdgeMaxima& maxima() { return maxima_; }
  /// The second half of run(): direction and position of the maxima.
  void take_directions(const PaddedPlane& plane, DeviceEdges& edges);

 private:
  void build(const std::map<std::string, std::string>& variants);
  void find_maxima_in_strips(const PaddedPlane& plane, const opencl::Buffer<cl_float>& threshold);
  void find_maxima_in_tiles(const PaddedPlane& plane, const opencl::Buffer<cl_float>& threshold);
  DetectionArguments arguments(const PaddedPlane& plane) const;

  using In = opencl::In<cl_float>;
  using Out = opencl::Out<cl_float>;
  using InInt = opencl::In<cl_int>;
  using OutInt = opencl::Out<cl_int>;
  using InByte = opencl::In<cl_uchar>;
  using OutByte = opencl::Out<cl_uchar>;

  opencl::Context& context_;
  int width_, height_;
  EdgesConfig config_;
  bool strips_ = true;
  std::size_t local_size_ = 1;
  int tiles_x_ = 0, tiles_y_ = 0;
  int line_ = 0;  ///< floats of one scratch line of a strip

  opencl::Kernel<DetectionArguments, In, cl_int, In, In, Out, cl_int, Out, OutInt> strip_maxima_;
  opencl::Kernel<DetectionArguments, In, In, InInt, InInt, Out> strip_directions_;
  opencl::Kernel<DetectionArguments, In, cl_int, In, In, Out, OutByte> tile_maxima_;
  opencl::Kernel<InByte, cl_int, OutInt> tile_count_;
  opencl::Kernel<InByte, cl_int, In, InInt, cl_int, Out, OutInt> tile_compact_;
  opencl::Kernel<DetectionArguments, In, In, InInt, InInt, Out> tile_directions_;
  Scan scan_;

  opencl::Buffer<cl_float> scratch_;  ///< strips: lines of column sums and gradients
  EdgeMaxima maxima_;
  opencl::Buffer<cl_float> compact_;  ///< tiles: winners in scan order
  opencl::Buffer<cl_int> rows_;       ///< tiles: their rows
};

}  // namespace quadedge::stages
