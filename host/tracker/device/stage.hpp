#pragma once
/// \file stage.hpp  What stages have in common: their variant, the scan, and a device that runs loops to their end.

#include <string>

#include "device/kernel.hpp"
#include "device/variants.hpp"

namespace quadedge::stages {

/// A stage on a device, in the variant that was chosen for it.
class Stage {
 protected:
  /// `name`: of the stage in the table of variants. \throws as opencl::choose_variant()
  Stage(opencl::Context& context, const std::string& name, const opencl::VariantChoice& chosen)
      : context_(context),
        variant_(opencl::choose_variant(name, context, chosen)),
        local_size_(static_cast<std::size_t>(variant_.local_size)) {}

  /// The following commands are profiled under this stage.
  void begin() { context_.begin_stage(variant_.stage); }
  bool is_grouped() const { return variant_.form == opencl::Form::groups; }
  /// A launch over `elements`, for example edges. Each has a work-item, or `sharing` of them in a variant whose groups
  /// share elements.
  opencl::Range over(std::size_t elements, std::size_t sharing = 1) const {
    return {elements * (is_grouped() ? sharing : 1), local_size_};
  }

  opencl::Context& context_;
  const opencl::Variant& variant_;
  std::size_t local_size_;  ///< work-items per group
};

/// Exclusive scan of counts with a capacity. Deterministic. Stage "scan" of the variants.
class Scan : private Stage {
 public:
  Scan(opencl::Context& context, const opencl::VariantChoice& variants);

  /// Enqueues first[i] = min(counts[0] + ... + counts[i - 1], capacity) for i = 0 .. count, and total = {elements that
  /// fit, elements cut off}. `counts` holds at least `count` values that are not negative; their sum must fit an int.
  /// `first` (count + 1) and `total` (2) grow as needed. Profiled as stage "scan"; afterwards the calling stage is
  /// current again.
  void run(const opencl::Buffer<cl_int>& counts, int count, int capacity, opencl::Buffer<cl_int>& first,
           opencl::Buffer<cl_int>& total);

 private:
  opencl::Kernel<void(const cl_int* counts, cl_int count, cl_int capacity, cl_int* first, cl_int* total)> kernel_;
};

/// Longer than the limits of known drivers; takes milliseconds.
constexpr cl_int kLongLoop = 1'000'000;

/// Runs a loop of `rounds` iterations in one work-item.
/// \returns one sentence on what is wrong; empty if the loop reaches its end \throws DeviceError
std::string long_loop_difference(opencl::Context& context, cl_int rounds = kLongLoop);

}  // namespace quadedge::stages
