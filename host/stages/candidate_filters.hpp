#pragma once
/// \file candidate_filters.hpp  Stage 4b: NCC, SIFT and the nearly-best filters over candidate lists, in stereo and in
/// time.

#include <map>
#include <string>

#include "common/filter_limits.hpp"
#include "opencl/argument_structs.hpp"
#include "stages/device_candidates.hpp"

namespace quadedge::stages {

/// Descriptions of a set of edges.
struct DescribedEdges {
  const opencl::Buffer<cl_char>& patches;  ///< see host/reference/patches.hpp
  const opencl::Buffer<cl_int>& patch_of;  ///< number of the patches of each edge
  const opencl::Buffer<cl_uchar>& sift;    ///< in the order of the edges, see host/reference/sift.hpp
};

/// Variants of the stage "candidate_filters".
class CandidateFilters {
 public:
  CandidateFilters(opencl::Context& context, const std::map<std::string, std::string>& variants);

  /// Fills ncc, sift and state of every candidate. Row r belongs to edge r * row_step of the first set.
  /// `all_scores`: computes both scores of every candidate, even where one of them decides (for a tap).
  void run(const DescribedEdges& a, const DescribedEdges& b, const FilterLimits& limits, int row_step, bool all_scores,
           DeviceCandidates& candidates);

 private:
  template <class T>
  using In = opencl::In<T>;
  template <class T>
  using Out = opencl::Out<T>;

  opencl::Context& context_;
  std::size_t local_size_, items_per_row_;
  opencl::Kernel<FilterArguments, In<cl_int>, In<cl_int>, In<cl_char>, In<cl_int>, In<cl_uchar>, In<cl_char>,
                 In<cl_int>, In<cl_uchar>, Out<cl_float>, Out<cl_float>, Out<cl_uchar>, Out<cl_int>>
      kernel_;
};

}  // namespace quadedge::stages
