#pragma once
/// \file wide_matching.hpp  Global matching of stereo edges of an earlier rig with the current left image:
/// kernels/wide_matching.cl and kernels/wide_matching_blocks.cl.

#include <map>
#include <string>

#include "opencl/argument_structs.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "stages/device_stereo_edges.hpp"

namespace quadedge::stages {

/// Every step-th stereo edge of a rig with its wide descriptor.
struct DeviceWideEdges {
  const DeviceStereoEdges& edges;
  int step;
  int rows;
  const opencl::Buffer<cl_uchar>& descriptors;
};

/// Variants of the stage "wide_matching".
class WideMatching {
 public:
  WideMatching(opencl::Context& context, const TemporalConfig& config,
               const std::map<std::string, std::string>& variants);

  /// See reference::wide_matches(). `current_edges` are those of `current` on the host.
  TemporalMatches run(const DeviceWideEdges& earlier, const DeviceWideEdges& current, const StereoEdges& current_edges);

 private:
  template <class T>
  using In = opencl::In<T>;
  template <class T>
  using Out = opencl::Out<T>;

  void transpose(const DeviceWideEdges& edges, opencl::Buffer<cl_uchar>& blocks);

  opencl::Context& context_;
  float neighbourhood_, ratio_;
  std::size_t local_size_;
  std::size_t rows_at_once_;  ///< of a work-item or, where `grouped_`, of a group
  bool grouped_, in_blocks_;
  opencl::Buffer<cl_uchar> earlier_blocks_, current_blocks_;
  opencl::Buffer<cl_int> best_;
  opencl::Buffer<cl_float> similarity_;
  opencl::Kernel<WideMatchingArguments, In<cl_uchar>, In<cl_float>, In<cl_uchar>, In<cl_float>, Out<cl_int>,
                 Out<cl_float>>
      kernel_;
  opencl::Kernel<In<cl_uchar>, cl_int, Out<cl_uchar>> transpose_;
  opencl::Kernel<WideMatchingArguments, In<cl_uchar>, In<cl_uchar>, In<cl_float>, In<cl_uchar>, In<cl_uchar>,
                 In<cl_float>, Out<cl_int>, Out<cl_float>>
      blocks_kernel_;
};

}  // namespace quadedge::stages
