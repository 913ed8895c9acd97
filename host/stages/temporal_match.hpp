#pragma once
/// \file temporal_match.hpp  Stage 6 in one kernel: from predicted places to quads, without SIFT and without lists.

#include <map>
#include <optional>
#include <string>

#include "common/filter_limits.hpp"
#include "common/temporal_search.hpp"
#include "opencl/kernel.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "stages/device_point_index.hpp"
#include "stages/device_stereo_edges.hpp"
#include "stages/temporal_candidates.hpp"

namespace quadedge::stages {

/// Rows that kept a candidate in each image before the agreement.
struct AliveRows {
  int left = 0, right = 0;
};

/// doc/method.md section 4 for searches without SIFT. Variants of the stage "temporal_match".
class TemporalMatch {
 public:
  TemporalMatch(opencl::Context& context, const TemporalConfig& config,
                const std::map<std::string, std::string>& variants);

  /// Whether the chosen variant is a fused kernel at all, and the limits leave SIFT out.
  bool serves(const TemporalSearch& search) const { return fused_ && temporal_limits(config_, search).sift_max == 0; }

  /// Matches and reads the rows back into `matches`; `edges` holds the current stereo edges on the host. `itself`: 0,
  /// 1, 2 ... \returns nothing where a row has more candidates than the kernel has room for: then lists have to be used
  std::optional<AliveRows> run(const DevicePlaces& left_predicted, const DevicePlaces& right_predicted,
                               const TemporalSearch& search, const DeviceStereoEdges& base,
                               const DeviceStereoEdges& current, const DevicePointIndex& left,
                               const DevicePointIndex& right, const opencl::Buffer<cl_int>& itself,
                               const StereoEdges& edges, TemporalMatches& matches);

 private:
  template <class T>
  using In = opencl::In<T>;
  template <class T>
  using Out = opencl::Out<T>;

  opencl::Context& context_;
  TemporalConfig config_;
  bool fused_;
  std::size_t local_size_;
  opencl::Buffer<cl_int> result_;
  std::vector<cl_int> rows_;
  opencl::Kernel<cl_int, cl_int, In<cl_float>, In<cl_float>, In<cl_float>, In<cl_float>, In<cl_float>, In<cl_float>,
                 In<cl_float>, In<cl_float>, In<cl_float>, In<cl_int>, In<cl_int>, cl_int, cl_int, In<cl_float>,
                 In<cl_float>, In<cl_float>, In<cl_int>, In<cl_int>, cl_int, cl_int, In<cl_char>, In<cl_int>,
                 In<cl_char>, In<cl_char>, In<cl_int>, In<cl_char>, In<cl_int>, In<cl_float>, cl_int, cl_float,
                 cl_float, cl_float, cl_float, cl_float, cl_float, cl_float, Out<cl_int>>
      kernel_;
};

}  // namespace quadedge::stages
