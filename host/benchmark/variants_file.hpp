#pragma once
/// \file variants_file.hpp  What `compare` writes: all figures, and the fastest kernel variants of a device.

#include <map>
#include <string>

#include "benchmark/variant_comparison.hpp"
#include "quadedge/config.hpp"
#include "quadedge/device.hpp"

namespace quadedge::bench {

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
