#pragma once
/// \file candidates.hpp  Candidate lists and stage 4b, the filters over them, in stereo and in time.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/filter_limits.hpp"
#include "device/stage.hpp"
#include "quadedge/filters.hpp"

namespace quadedge::stages {

/// How many of the first `count` values are positive; waits for the device.
inline int count_positive(const opencl::Buffer<cl_int>& values, int count) {
  const auto read = values.read(static_cast<std::size_t>(count));
  return static_cast<int>(std::count_if(read.begin(), read.end(), [](cl_int value) { return value > 0; }));
}

/// Candidate lists in compressed rows, with the scores of every candidate. If the capacity is exceeded, the buffers
/// grow and the sweep runs again, so no candidate is lost.
struct DeviceCandidates {
  opencl::Buffer<cl_int> counts;       ///< candidates per row
  opencl::Buffer<cl_int> first;        ///< rows + 1
  opencl::Buffer<cl_int> total;        ///< {candidates that fit, candidates cut off}
  opencl::Buffer<cl_int> target;       ///< index of the other edge
  opencl::Buffer<cl_float> ncc, sift;  ///< similarity and distance
  opencl::Buffer<cl_uchar> state;      ///< alive, rejected by or represented: kernels/layouts.cl
  opencl::Buffer<cl_int> alive;        ///< survivors of the filters per row
  int rows = 0;
  int capacity = 0;
  int host_total = 0;

  /// Allocates room for `wanted` candidates. Growing discards the contents.
  void reserve(opencl::Context& context, int wanted) {
    capacity = std::max(capacity, wanted);
    const auto size = static_cast<std::size_t>(capacity);
    target.ensure(context, size);
    ncc.ensure(context, size);
    sift.ensure(context, size);
    state.ensure(context, size);
  }

  /// Turns counts into lists: `fill` enqueues the second sweep, after the buffers have grown to the size of the lists.
  template <class Fill>
  void build(opencl::Context& context, Scan& scan, const Fill& fill) {
    for (;;) {
      scan.run(counts, rows, capacity, first, total);
      cl_int values[2];
      total.read(values, 2);
      host_total = values[0];
      if (values[1] == 0) break;
      reserve(context, (values[0] + values[1]) + (values[0] + values[1]) / 4);
    }
    fill();
  }

  /// Number of rows with a candidate that passed all filters.
  int living_rows() const { return count_positive(alive, rows); }

  /// All candidates without scores, for a tap.
  CandidateLists read() const;
};

/// How directions of candidates are compared: modulo a full turn or, as in the paper, half a turn.
enum class Turns { full, half };

/// The program of a stage that finds candidates.
cl::Program candidates_program(opencl::Context& context, const opencl::Variant& variant, Turns turns);

/// Descriptions of a set of edges.
struct DescribedEdges {
  const opencl::Buffer<cl_char>& patches;  ///< see reference/edge_descriptions.hpp
  const opencl::Buffer<cl_int>& patch_of;  ///< number of the patches of each edge
  const opencl::Buffer<cl_uchar>& sift;    ///< in the order of the edges, see reference/edge_descriptions.hpp
};

/// candidate_filters() of kernels/candidate_filters.cl.
using CandidateKernel = opencl::Kernel<void(FilterArguments args, const cl_int* first, const cl_int* target,
                                            const cl_char* patches_a, const cl_int* patch_of_a, const cl_uchar* sift_a,
                                            const cl_char* patches_b, const cl_int* patch_of_b, const cl_uchar* sift_b,
                                            cl_float* ncc, cl_float* sift, cl_uchar* state, cl_int* alive)>;

/// Stage 4b: NCC, SIFT and the nearly-best filters over candidate lists.
/// Variants of the stage "candidate_filters".
class CandidateFilters : private Stage {
 public:
  CandidateFilters(opencl::Context& context, const opencl::VariantChoice& variants);

  /// Fills ncc, sift and state of every candidate. Row r belongs to edge r * row_step of the first set.
  /// `all_scores`: computes both scores of every candidate, even where one of them decides (for a tap).
  void run(const DescribedEdges& a, const DescribedEdges& b, const FilterLimits& limits, int row_step, bool all_scores,
           DeviceCandidates& candidates);

 private:
  CandidateKernel kernel_;
};

}  // namespace quadedge::stages
