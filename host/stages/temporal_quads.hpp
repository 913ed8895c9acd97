#pragma once
/// \file temporal_quads.hpp  Stage 6b: agreement of left and right, and the best of what remains: quads.

#include <map>
#include <string>

#include "common/temporal_search.hpp"
#include "opencl/argument_structs.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "stages/device_candidates.hpp"
#include "stages/device_stereo_edges.hpp"

namespace quadedge::stages {

/// Agreement of both images and selection of the best candidate (doc/method.md section 4). Variants of the stage
/// "temporal_quads".
class TemporalQuads {
 public:
  TemporalQuads(opencl::Context& context, const TemporalConfig& config,
                const std::map<std::string, std::string>& variants);

  /// Enqueues the agreement: rejects left candidates that are not alive in the right list.
  void agree(DeviceCandidates& left, const DeviceCandidates& right);
  /// Selects the best candidates, reads the rows back and returns the quads. `edges` holds the stereo edges `current`
  /// on the host. \param predicted in the left image
  TemporalMatches collect(const DeviceStereoEdges& current, const StereoEdges& edges, const TemporalSearch& search,
                          const PositionsView& predicted, const DeviceCandidates& left);

 private:
  template <class T>
  using In = opencl::In<T>;
  template <class T>
  using Out = opencl::Out<T>;

  opencl::Context& context_;
  TemporalConfig config_;
  std::size_t local_size_;
  opencl::Buffer<cl_float> score_;
  opencl::Buffer<cl_int> label_, result_;
  opencl::Kernel<TemporalAgreementArguments, In<cl_int>, In<cl_int>, In<cl_float>, Out<cl_uchar>, In<cl_int>,
                 In<cl_int>, In<cl_float>, In<cl_uchar>, Out<cl_float>>
      agree_;
  opencl::Kernel<TemporalBestArguments, In<cl_int>, In<cl_int>, In<cl_uchar>, In<cl_float>, In<cl_float>, In<cl_float>,
                 Out<cl_int>, Out<cl_int>>
      best_;
};

}  // namespace quadedge::stages
