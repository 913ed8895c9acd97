#pragma once
/// \file device_candidates.hpp  Candidate lists and their scores on the device.

#include <algorithm>

#include "opencl/kernel.hpp"
#include "stages/judged_candidates.hpp"
#include "stages/scan.hpp"

namespace quadedge::stages {

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
  int living_rows() const {
    const auto counts_per_row = alive.read(static_cast<std::size_t>(rows));
    return static_cast<int>(
        std::count_if(counts_per_row.begin(), counts_per_row.end(), [](cl_int n) { return n > 0; }));
  }

  /// All candidates without scores; with scores and the decisions of the filters, for a tap.
  CandidateLists read() const;
  JudgedCandidates read_judged() const;
};

}  // namespace quadedge::stages
