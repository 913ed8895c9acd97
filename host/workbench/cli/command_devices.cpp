/// \file command_devices.cpp  quadedge devices and quadedge variants: what can be chosen.
#include <cstdio>

#include "cli/command.hpp"
#include "cli/method_options.hpp"
#include "device/variants.hpp"
#include "quadedge/device.hpp"

namespace quadedge::cli {
namespace {

/// Result of the self-test of a device with its default kernels.
std::string soundness(const DeviceInfo& device) {
  const auto verdict = kept_verdict(device, {});
  if (!verdict) return "not run yet; runs at first use";
  return verdict->passed() ? "passed" : "FAILED at " + verdict->stage + ": " + verdict->difference;
}

class DevicesCommand : public Command {
 public:
  DevicesCommand()
      : Command("devices", "list the OpenCL devices that --device can choose",
                "  quadedge devices\n"
                "  QUADEDGE_DEVICE=0 quadedge demo") {}
  void declare(Options&) override {}
  int run() override {
    const auto devices = list_devices();
    std::printf("%-9s  %-11s  %5s  %9s  %s\n", "--device", "type", "units", "memory",
                "name (platform, driver, OpenCL)");
    for (const auto& device : devices) {
      std::printf("%-9d  %-11s  %5u  %6.1f GB  %s (%s, %s, %s)\n", device.index, device.type.c_str(),
                  device.compute_units, static_cast<double>(device.memory_bytes) * 1e-9, device.name.c_str(),
                  device.platform.c_str(), device.driver.c_str(), device.opencl.c_str());
      std::printf("%-9s  self-test: %s\n", "", soundness(device).c_str());
    }
    std::printf("%-9s  %-11s  %5d  %9s  %s\n", "reference", "reference", 1, "-",
                "plain C++ on one core, without OpenCL; slow");
    if (devices.empty()) {
      std::printf(
          "\nno OpenCL device was found: `pip install intel-opencl-rt intel-cmplr-lib-rt` beside the Python package\n"
          "(x86-64) or, on Debian, `apt-get install pocl-opencl-icd ocl-icd-libopencl1` installs one for CPUs, and a\n"
          "GPU needs its vendor's driver; `clinfo -l` lists devices\n");
    }
    return 0;
  }
};

class VariantsCommand : public Command {
 public:
  VariantsCommand()
      : Command("variants", "list the kernel variants that --variant can choose",
                "  quadedge variants\n"
                "  quadedge demo --variant patches=lanes") {}
  void declare(Options&) override {}
  int run() override {
    std::printf("%-14s %-16s %10s  %-10s %s\n", "stage", "variant", "local size", "default", "about");
    for (const auto& variant : opencl::all_variants()) {
      const char* mark = variant.default_on_cpu   ? (variant.default_on_gpu ? "cpu, gpu" : "cpu")
                         : variant.default_on_gpu ? "gpu"
                                                  : "";
      std::printf("%-14s %-16s %10d  %-10s %s\n", variant.stage.c_str(), variant.name.c_str(), variant.local_size, mark,
                  variant.about.c_str());
    }
    return 0;
  }
};

}  // namespace

std::unique_ptr<Command> make_devices_command() { return std::make_unique<DevicesCommand>(); }
std::unique_ptr<Command> make_variants_command() { return std::make_unique<VariantsCommand>(); }

}  // namespace quadedge::cli
