#include "cli/method_options.hpp"

#include "opencl/variants.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {

void MethodOptions::declare(Options& options) {
  options.group("Method and device");
  options.text("--device", device_, "auto, cpu, gpu, reference, a number of `quadedge devices`, or a part of a name",
               "DEVICE");
  options.environment("QUADEDGE_DEVICE");
  options.config_file();
  options.repeated("--variant", variants_, "kernel variant of a stage (`quadedge variants`), repeatable", "STAGE=NAME");
  options.text("--kernels", kernels_, "read the kernels from this folder instead of the built-in ones", "DIR");
  visit_config(config_, [&](const std::string& name, ConfigField field, const std::string& help, double, double) {
    std::string names = "--" + name;
    if (name == "stereo.max_disparity") names = "--max-disparity," + names;
    const bool always_shown = name == "seed" || name == "stereo.max_disparity";
    options.group(always_shown ? "Method and device" : "Constants of the method", !always_shown);
    if (auto** real = std::get_if<double*>(&field)) options.number(names, **real, help);
    if (auto** whole = std::get_if<int*>(&field)) options.number(names, **whole, help);
    if (auto** seed = std::get_if<std::uint64_t*>(&field)) options.number(names, **seed, help);
    if (auto** truth = std::get_if<bool*>(&field)) options.boolean(names, **truth, help);
    if (auto** text = std::get_if<std::string*>(&field)) options.text(names, **text, help, "TEXT");
  });
}

Config MethodOptions::config() const {
  Config config = config_;
  for (const auto& choice : variants_) {
    const auto equals = choice.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw UsageError("--variant " + choice + ": expected STAGE=NAME as `quadedge variants` lists them");
    }
    config.variants[choice.substr(0, equals)] = choice.substr(equals + 1);
  }
  opencl::check_variants(config.variants);
  check_config(config);
  return config;
}

}  // namespace quadedge::cli
