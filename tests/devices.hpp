#pragma once
/// \file devices.hpp  All OpenCL devices of this machine, for tests. Without any device, tests fail; they do not skip.

#include <catch2/catch.hpp>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "device/context.hpp"
#include "device/variants.hpp"
#include "quadedge/device.hpp"

/// Names ("0", "1", ...) of all devices. Fails the test if there is none.
inline std::vector<std::string> all_devices() {
  std::vector<std::string> names;
  for (const auto& info : quadedge::list_devices()) names.push_back(std::to_string(info.index));
  if (names.empty()) FAIL("no OpenCL device: install pocl-opencl-icd");
  return names;
}

/// The same and the reference.
inline std::vector<std::string> all_devices_and_reference() {
  std::vector<std::string> names = all_devices();
  names.emplace_back("reference");
  return names;
}

/// Caches built programs in the folder QUADEDGE_TEST_CACHE, as the program does. If unset, every test builds its
/// programs.
inline quadedge::DeviceOptions kept_programs() {
  quadedge::DeviceOptions options;
  const char* folder = std::getenv("QUADEDGE_TEST_CACHE");
  if (folder != nullptr) options.program_folder = std::string(folder) + "/quadedge/programs";
  return options;
}

/// Variants by stage.
using Variants = std::map<std::string, std::string>;

/// Every variant of a stage on every device.
inline void for_each_variant(
    const std::string& stage,
    const std::function<void(quadedge::opencl::Context& context, const Variants& variants)>& visit) {
  for (const auto& index : all_devices()) {
    quadedge::Device device(index, kept_programs());
    for (const auto& variant : quadedge::opencl::all_variants()) {
      if (variant.stage != stage) continue;
      INFO(device.info().name << " " << variant.name);
      visit(*device.context(), {{stage, variant.name}});
    }
  }
}
