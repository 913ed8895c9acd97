#pragma once
/// \file temporal_match.hpp  Stage 6 in one kernel: from predicted positions to quads, without SIFT and without lists.

#include <map>
#include <optional>
#include <string>

#include "common/filter_limits.hpp"
#include "common/temporal_search.hpp"
#include "opencl/argument_structs.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "stages/device_stereo_edges.hpp"
#include "stages/point_index.hpp"

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

  /// True if the variant is a fused kernel and the search does not use SIFT.
  bool serves(const TemporalSearch& search) const { return fused_ && temporal_limits(config_, search).sift_max == 0; }

  /// Matches and reads the rows back into `matches`; `edges` holds the current stereo edges on the host. `predicted`:
  /// the lists of the left and of the right image; `left` and `right`: the point indices of the current stereo edges.
  /// \returns nothing where a row has more candidates than the kernel has room for: then lists have to be
  /// used
  std::optional<AliveRows> run(const DevicePositions& predicted, const TemporalSearch& search,
                               const DeviceStereoEdges& base, const DeviceStereoEdges& current,
                               const DevicePointIndex& left, const DevicePointIndex& right, const StereoEdges& edges,
                               TemporalMatches& matches);

 private:
  template <class T>
  using In = opencl::In<T>;
  template <class T>
  using Out = opencl::Out<T>;

  /// Reads the rows of the result back. \returns nothing where a row has no room for its candidates
  std::optional<AliveRows> read_quads(std::size_t rows, int step, const StereoEdges& edges, TemporalMatches& matches);

  opencl::Context& context_;
  TemporalConfig config_;
  bool fused_;
  std::size_t local_size_, items_per_row_;
  opencl::Buffer<cl_int> result_;
  opencl::ReadBack read_back_;
  opencl::Kernel<TemporalMatchArguments, In<cl_float>, In<cl_float>, In<cl_int>, In<cl_float>, In<cl_int>, In<cl_char>,
                 In<cl_int>, In<cl_char>, In<cl_char>, In<cl_int>, In<cl_char>, In<cl_float>, Out<cl_int>>
      kernel_;
};

}  // namespace quadedge::stages
