#pragma once
/// \file variants.hpp  The table of kernel variants.

#include <map>
#include <string>
#include <vector>

#include "opencl/context.hpp"

namespace quadedge::opencl {

/// A variant of a stage. All variants of a stage give the same result.
struct Variant {
  std::string stage;  ///< "edge_detection", "patches", "sift", ...
  std::string name;   ///< "cpu", "gpu", ...
  Defines defines;    ///< compile-time parameters
  int local_size;     ///< work-items per group in x
  bool default_on_cpu;
  bool default_on_gpu;
  std::string about;    ///< one sentence for `quadedge variants`
  int local_bytes = 0;  ///< upper bound of the local memory of a group
};

/// Every variant of every stage, in the order of the stages.
const std::vector<Variant>& all_variants();

/// The variant of `stage` selected in `chosen`, else the default for the type of the device. If the device cannot run
/// that, because its groups or local memory are too small, the variant with the largest groups that it can run.
/// \throws UsageError for an unknown name, with the known ones; DeviceError if the device cannot run the variant
const Variant& choose_variant(const std::string& stage, const Context& context,
                              const std::map<std::string, std::string>& chosen);

/// \throws UsageError if `chosen` contains an unknown stage or variant
void check_variants(const std::map<std::string, std::string>& chosen);

}  // namespace quadedge::opencl
