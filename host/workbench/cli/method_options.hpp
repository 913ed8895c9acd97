#pragma once
/// \file method_options.hpp  Options that all computing commands share: the device, tested once, and every
/// constant of the method.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "quadedge/config.hpp"
#include "quadedge/device.hpp"
#include "quadedge/self_test.hpp"

namespace quadedge::cli {

/// Edges per image that `bench` and `compare` have of the built-in sequence: half of what the paper reports, whose
/// edges are half a pixel apart.
constexpr int kBenchEdges = 25'000;

// Verdicts of the self-test, kept for every device, driver and program.

/// What was found when this program tested the device with these variants, with this driver; nothing where it has not
/// been, or where the file is damaged or cannot be read.
std::optional<SelfTestResult> kept_verdict(const DeviceInfo& device, const std::map<std::string, std::string>& variants,
                                           const std::string& method = "quadedge");

/// Declares the shared options, then turns them into a checked configuration and a device.
class MethodOptions {
 public:
  /// --device, --threads, --trust, --config, --variant, --kernels, and --KEY for every
  /// constant.
  void declare(Options& options);
  /// To be called before declare(): rendered sequences have a rig without errors, unless options state one.
  void assume_exact_rig();
  /// The checked configuration. \throws UsageError for a value out of range, an unknown stage or variant.
  Config config() const;
  /// Limits the threads, opens the device and runs its self-test, unless this program has a verdict on it with this
  /// driver. With `auto` a device that fails is skipped with a warning as long as there is another.
  /// \param test receives the verdict
  /// \throws DeviceError for a device that computes wrongly, unless --trust is given; UsageError for fewer
  /// than no threads.
  Device open_device(bool profiling = false, SelfTestResult* test = nullptr) const;
  /// The value of --device.
  const std::string& device_choice() const { return device_; }
  /// Whether --trust is given.
  bool trusts() const { return trusts_; }
  /// The value of --threads; 0: all.
  int threads() const { return threads_; }
  /// The value of --kernels; empty: the built-in kernels.
  const std::string& kernel_folder() const { return kernels_; }

 private:
  /// What to open, in this order until a device passes.
  std::vector<std::string> choices() const;
  Device open_device(const std::string& choice, const DeviceOptions& options, SelfTestResult* test) const;

  Config config_;
  std::string device_ = "auto";
  int threads_ = 0;
  bool trusts_ = false;
  std::string kernels_;
  std::vector<std::string> variants_;
};

}  // namespace quadedge::cli
