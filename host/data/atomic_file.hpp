#pragma once
/// \file atomic_file.hpp  Writes output files completely or not at all.

#include <string>
#include <string_view>

namespace quadedge::data {

/// Checks, before long work, that write_atomically() can put a file here. \throws DataError with the system's reason
void check_writable(const std::string& path);

/// Writes to a temporary name in the same folder and renames it, so that readers never see an incomplete file and a
/// failure leaves an existing file unchanged. Devices and pipes are written directly. \throws DataError with the
/// system's reason
void write_atomically(const std::string& path, std::string_view bytes);

}  // namespace quadedge::data
