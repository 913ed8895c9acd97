#pragma once
/// \file stereo_clusters.hpp  Stage 5b: clusters of candidates and their representatives.

#include <map>
#include <string>

#include "opencl/argument_structs.hpp"
#include "quadedge/config.hpp"
#include "stages/device_candidates.hpp"
#include "stages/device_edges.hpp"
#include "stages/stereo_refinement.hpp"

namespace quadedge::stages {

/// Clusters of one frame's candidates, in the rows of the candidates.
struct DeviceClusters {
  opencl::Buffer<cl_int> order;  ///< scratch
  opencl::Buffer<cl_int> count;  ///< clusters per left edge
  /// Three blocks of `stride` floats: position on the epipolar line [px from the point at infinity], direction [rad],
  /// similarity.
  opencl::Buffer<cl_float> packed;
  int stride = 0;
  opencl::Buffer<cl_int> anchor;  ///< right edge of the representative
};

/// doc/method.md section 3, 8c. Variants of the stage "stereo_clusters".
class StereoClusters {
 public:
  StereoClusters(opencl::Context& context, const StereoConfig& config,
                 const std::map<std::string, std::string>& variants);

  void run(const DeviceEdges& left, const DeviceEdges& right, const DeviceCandidates& candidates,
           const DeviceRefined& refined, DeviceClusters& clusters);

 private:
  template <class T>
  using In = opencl::In<T>;
  template <class T>
  using Out = opencl::Out<T>;

  opencl::Context& context_;
  StereoConfig config_;
  std::size_t local_size_;
  opencl::Kernel<StereoClusterArguments, In<cl_int>, In<cl_int>, In<cl_float>, In<cl_uchar>, In<cl_float>, In<cl_float>,
                 Out<cl_int>, Out<cl_int>, Out<cl_float>, Out<cl_int>>
      cluster_;
};

}  // namespace quadedge::stages
