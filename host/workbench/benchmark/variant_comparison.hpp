#pragma once
/// \file variant_comparison.hpp  Compares all kernel variants of a stage on the same input; the file of figures
/// and fastest variants.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "quadedge/config.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/device.hpp"

namespace quadedge::bench {

/// The result for one variant.
struct VariantResult {
  std::string name;
  bool is_default = false;
  bool runs = true;      ///< false: the device cannot run it, for the reason in `why`
  bool agrees = false;   ///< with the reference in the self-test, and byte for byte with the default on the input
  std::string why;       ///< the reason if there is no time, else empty
  double median_ms = 0;  ///< of the stage in one frame by OpenCL events; NaN without a time
  double p10_ms = 0, p90_ms = 0;
  double ratio_to_default = 0;  ///< median over the repetitions of the ratio to the default's time
  double ratio_p90 = 0;         ///< 90th percentile of the ratio; below 1, the gain exceeds the noise
};

/// All variants of one stage.
struct StageResult {
  std::string stage;
  std::vector<VariantResult> variants;
  /// The fastest variant that agrees: the default unless another one is at least 3 % faster and faster in nine of ten
  /// repetitions. Empty if the input never runs the stage.
  std::string best() const;
};

/// The input of a comparison.
struct VariantInput {
  const StereoRig& rig;
  const FramePrefetcher::Frame& first;
  const FramePrefetcher::Frame& second;
  Config config;  ///< complete; its variants are used by all other stages
  /// The device, with profiling; a new one for the next calls if it has failed.
  std::function<std::shared_ptr<Device>(bool has_failed)> device;
  int repetitions = 9;
};

/// Checks all variants of a stage, then measures them alternately; one that takes more than twice the default's time in
/// each of its first three measurements is not measured again. `progress` is called with the current activity.
/// \throws DeviceError if the default variant does not run.
StageResult compare_variants(const std::string& stage, const VariantInput& input,
                             const std::function<void(const std::string&)>& progress);

/// Names of all stages with variants, in order.
std::vector<std::string> stages_with_variants();

// What `compare` writes: all figures, and the fastest kernel variants of a device.

/// The results as JSON (doc/design.md section 10).
std::string comparison_json(const DeviceInfo& device, const std::vector<StageResult>& stages,
                            const std::string& command);

/// File name for a device: "variants-NAME.json", where NAME has only letters, digits and "-".
std::string variants_file_name(const DeviceInfo& device);

/// Writes stage -> variant. \throws DataError when the file cannot be written.
void write_variants_file(const std::string& path, const DeviceInfo& device,
                         const std::map<std::string, std::string>& variants);

/// Reads stage -> variant; empty if the file does not exist.
/// \throws UsageError, naming the file, if it has other content, belongs to another device, or names a stage or variant
/// that does not exist.
std::map<std::string, std::string> read_variants_file(const std::string& path, const DeviceInfo& device);

/// $XDG_CONFIG_HOME/quadedge/variants-DEVICE.json, or ~/.config where that is not set; empty where neither is.
std::string saved_variants_path(const DeviceInfo& device);

/// Stages without a variant in the configuration get the one saved for this device, if any.
/// \throws UsageError that names the file when it is not fit for this device or program.
void add_saved_variants(const Device& device, Config& config);

}  // namespace quadedge::bench
