#include "cli/method_options.hpp"

#include "opencl/variants.hpp"
#include "report/config_toml.hpp"

namespace quadedge::cli {
namespace {

constexpr const char* kShared = "Method and device";

/// Heading of a section's constants in the help.
std::string heading(const std::string& section) {
  for (const auto& known : constant_sections()) {
    if (known.name == section)
      return known.title + " (doc/method.md section " + std::to_string(known.method_section) + ")";
  }
  return kShared;
}

}  // namespace

void MethodOptions::declare(Options& options) {
  options.group(kShared);
  options.text("--device", device_, "auto, cpu, gpu, reference, a number of `quadedge devices`, or a part of a name",
               "DEVICE");
  options.environment("QUADEDGE_DEVICE");
  options.config_file();
  options.repeated("--variant", variants_, "kernel variant of a stage (`quadedge variants`), repeatable", "STAGE=NAME");
  options.text("--kernels", kernels_, "read the kernels from this folder instead of the built-in ones", "DIR");
  for (const Constant& constant : constants()) {
    const std::string shorter = constant.key() == "stereo.max_disparity" ? "--max-disparity," : "";
    options.group(heading(constant.section), !constant.basic);
    options.constant(shorter + "--" + constant.key(), constant, config_);
  }
}

Config MethodOptions::config() const {
  Config config = config_;
  for (const auto& choice : variants_) report::add_variant(choice, config);
  opencl::check_variants(config.variants);
  check_config(config);
  return config;
}

}  // namespace quadedge::cli
