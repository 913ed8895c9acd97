#pragma once
/// \file variants.hpp  The table of kernel variants.

#include <map>
#include <string>
#include <vector>

#include "device/context.hpp"

namespace quadedge::opencl {

/// How a variant shares out the work; decides what the stage's host code launches.
enum class Form {
  items,   ///< every work-item on its own, for example one per edge
  groups,  ///< the work-items of a group share an edge, row or tile through local memory, or share out a scan
  lists    ///< no kernel of its own: the stages that pass lists on take its place
};

/// The variants that a configuration selects: stage -> name.
using VariantChoice = std::map<std::string, std::string>;

/// A variant of a stage. All variants of a stage give the same result.
struct Variant {
  std::string stage;               ///< "edge_detection", "patches", "sift", ...
  std::string name;                ///< "strip", "group64", ...
  std::vector<std::string> files;  ///< of its program, in order
  Form form;
  Defines defines;  ///< compile-time parameters
  int local_size;   ///< work-items per group in x
  bool default_on_cpu;
  bool default_on_gpu;
  std::string about;    ///< one sentence for `quadedge variants`
  int local_bytes = 0;  ///< upper bound of the local memory of a group

  /// Builds `files`, with `others` in addition to `defines`. \throws DeviceError
  cl::Program program(Context& context, Defines others = {}) const;
};

/// Every variant of every stage, in the order of the stages.
const std::vector<Variant>& all_variants();

/// A program with `files`, which belong to default variants or prepare their data. On CPUs these share a few programs:
/// PoCL reads OpenCL's own header anew for every program, which takes longer than most kernels.
/// \throws as Context::program()
cl::Program joint_program(Context& context, const std::vector<std::string>& files, Defines defines = {});

/// The variant of `stage` selected in `chosen`, else the default for the type of the device. If the device cannot run
/// that, because its groups or local memory are too small, the variant with the largest groups that it can run.
/// \throws UsageError for an unknown name, with the known ones; DeviceError if the device cannot run the variant
const Variant& choose_variant(const std::string& stage, const Context& context, const VariantChoice& chosen);

/// \throws UsageError if `chosen` contains an unknown stage or variant
void check_variants(const VariantChoice& chosen);

}  // namespace quadedge::opencl
