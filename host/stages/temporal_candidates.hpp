#pragma once
/// \file temporal_candidates.hpp  Stage 6a: current stereo edges near the predicted positions, in the left or the right
/// images.

#include <map>
#include <string>

#include "opencl/argument_structs.hpp"
#include "stages/device_candidates.hpp"
#include "stages/point_index.hpp"

namespace quadedge::stages {

/// Filters 1 and 2 of doc/method.md section 4. Variants of the stage "temporal_candidates".
class TemporalCandidates {
 public:
  TemporalCandidates(opencl::Context& context, const std::map<std::string, std::string>& variants);

  /// `radius` [px], `orientation` [rad]. Every row_step-th predicted position has a row. `current`: the stereo edges of
  /// one side.
  void run(const PositionsView& predicted, int row_step, const DevicePointIndex& current, float radius,
           float orientation, DeviceCandidates& candidates);

 private:
  template <class T>
  using In = opencl::In<T>;
  template <class T>
  using Out = opencl::Out<T>;

  opencl::Context& context_;
  std::size_t local_size_;
  Scan scan_;
  opencl::Kernel<TemporalCandidateArguments, In<cl_float>, In<cl_float>, In<cl_int>, Out<cl_int>> count_;
  opencl::Kernel<TemporalCandidateArguments, In<cl_float>, In<cl_float>, In<cl_int>, In<cl_int>, cl_int, Out<cl_int>>
      fill_;
};

}  // namespace quadedge::stages
