#pragma once
/// \file scan.hpp  Exclusive prefix sums on the device: the middle of every count, scan, scatter.

#include <map>
#include <string>

#include "opencl/kernel.hpp"

namespace quadedge::stages {

/// Exclusive scan of counts with a capacity. Deterministic. Stage "scan" of the variants.
class Scan {
 public:
  Scan() = default;
  Scan(opencl::Context& context, const std::map<std::string, std::string>& variants);

  /// Enqueues first[i] = min(counts[0] + ... + counts[i - 1], capacity) for i = 0 .. count, and total = {elements that
  /// fit, elements cut off}. `counts` holds at least `count` values that are not negative; their sum must fit an int.
  /// `first` (count + 1) and `total` (2) grow as needed. Profiled as stage "scan"; afterwards the calling stage is
  /// current again.
  void run(const opencl::Buffer<cl_int>& counts, int count, int capacity, opencl::Buffer<cl_int>& first,
           opencl::Buffer<cl_int>& total);

 private:
  opencl::Context* context_ = nullptr;
  std::size_t local_size_ = 1, groups_ = 1;  ///< groups for large scans
  opencl::Kernel<opencl::In<cl_int>, cl_int, cl_int, opencl::Out<cl_int>, opencl::Out<cl_int>> kernel_;
};

}  // namespace quadedge::stages
