#pragma once
/// \file saved_variants.hpp  The user's kernel variants of each device.

#include <string>

#include "quadedge/config.hpp"
#include "quadedge/device.hpp"

namespace quadedge::cli {

/// $XDG_CONFIG_HOME/quadedge/variants-DEVICE.json, or ~/.config where that is not set; empty where neither is.
std::string saved_variants_path(const DeviceInfo& device);

/// Stages without a variant in the configuration get the one saved for this device, if any.
/// \throws UsageError that names the file when it is not fit for this device or program.
void add_saved_variants(const Device& device, Config& config);

}  // namespace quadedge::cli
