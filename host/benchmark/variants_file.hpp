#pragma once
/// \file variants_file.hpp  The fastest kernel variants of a device, as saved by `compare --save`.

#include <map>
#include <string>

#include "quadedge/device.hpp"

namespace quadedge::bench {

/// File name for a device: "variants-NAME.json", where NAME has only letters, digits and "-".
std::string variants_file_name(const DeviceInfo& device);

/// Writes stage -> variant. \throws DataError when the file cannot be written.
void write_variants_file(const std::string& path, const DeviceInfo& device,
                         const std::map<std::string, std::string>& variants);

/// Reads stage -> variant; empty if the file does not exist.
/// \throws UsageError, naming the file, if it has other content, belongs to another device, or names a stage or variant
/// that does not exist.
std::map<std::string, std::string> read_variants_file(const std::string& path, const DeviceInfo& device);

}  // namespace quadedge::bench
