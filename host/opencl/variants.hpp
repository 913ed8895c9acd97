#pragma once
/// \file variants.hpp  Kernel variants as data: every stage's choices in one table.

#include <map>
#include <string>
#include <vector>

#include "opencl/context.hpp"

namespace quadedge::opencl {

/// One way to run a stage. All variants of a stage give the same result.
struct Variant {
  std::string stage;  ///< "edge_detection", "patches", "sift", ...
  std::string name;   ///< "cpu", "gpu", ...
  Defines defines;    ///< compile-time parameters
  int local_size;     ///< work-items per group in x
  bool default_on_cpu;
  bool default_on_gpu;
  std::string about;    ///< one sentence for `quadedge variants`
  int local_bytes = 0;  ///< of local memory that a group takes, or a little more
};

/// Every variant of every stage, in the order of the stages.
const std::vector<Variant>& all_variants();

/// The variant of `stage` that `chosen` names, or else the default of the device's class; where the device's groups or
/// its local memory are too small for that, the one with the largest groups that it can run.
/// \throws UsageError for an unknown name, listing the known ones, DeviceError where the device cannot run it.
const Variant& choose_variant(const std::string& stage, const Context& context,
                              const std::map<std::string, std::string>& chosen);

/// \throws UsageError when `chosen` names a stage or a variant that does not exist.
void check_variants(const std::map<std::string, std::string>& chosen);

}  // namespace quadedge::opencl
