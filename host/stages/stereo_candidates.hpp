#pragma once
/// \file stereo_candidates.hpp  Stage 4a: right edges on each left edge's epipolar segment with a similar direction.

#include <map>
#include <string>

#include "common/epipolar_geometry.hpp"
#include "opencl/argument_structs.hpp"
#include "stages/device_candidates.hpp"
#include "stages/device_edges.hpp"

namespace quadedge::stages {

/// Filters 1 to 3 of doc/method.md section 3. Variants of the stage "stereo_candidates".
class StereoCandidates {
 public:
  StereoCandidates(opencl::Context& context, const std::map<std::string, std::string>& variants);

  /// One row per left edge. `right_height` [px].
  void run(const DeviceEdges& left, const DeviceEdges& right, int right_height, const EpipolarGeometry& geometry,
           const DisparityProbe& probe, DeviceCandidates& candidates);

  /// Of the last run: which right edges are candidates (1, else 0).
  const opencl::Buffer<cl_int>& listed() const { return listed_; }

 private:
  template <class T>
  using In = opencl::In<T>;
  template <class T>
  using Out = opencl::Out<T>;

  opencl::Context& context_;
  std::size_t local_size_;
  Scan scan_;
  opencl::Buffer<cl_int> noted_;  ///< the first candidates of every row
  opencl::Buffer<cl_int> listed_;
  opencl::Kernel<StereoCandidateArguments, In<cl_float>, In<cl_float>, In<cl_int>, Out<cl_int>, Out<cl_int>,
                 Out<cl_int>>
      count_;
  opencl::Kernel<StereoCandidateArguments, In<cl_float>, In<cl_float>, In<cl_int>, In<cl_int>, cl_int, In<cl_int>,
                 Out<cl_int>, Out<cl_int>>
      fill_;
};

}  // namespace quadedge::stages
