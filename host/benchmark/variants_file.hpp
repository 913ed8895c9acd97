#pragma once
/// \file variants_file.hpp  The kernel variants that were fastest on one device, as `compare --save` stores them.

#include <map>
#include <string>

#include "quadedge/device.hpp"

namespace quadedge::bench {

/// Name of the file of a device: "variants-NAME.json", NAME in letters, digits and "-".
std::string variants_file_name(const DeviceInfo& device);

/// Writes stage -> variant. \throws DataError when the file cannot be written.
void write_variants_file(const std::string& path, const DeviceInfo& device,
                         const std::map<std::string, std::string>& variants);

/// Reads stage -> variant; nothing where there is no such file.
/// \throws UsageError, naming the file, when it holds anything else, was made on another device, or names a stage or
/// variant that does not exist.
std::map<std::string, std::string> read_variants_file(const std::string& path, const DeviceInfo& device);

}  // namespace quadedge::bench
