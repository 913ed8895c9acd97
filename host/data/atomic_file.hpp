#pragma once
/// \file atomic_file.hpp  Output files that are complete or not there at all.

#include <string>
#include <string_view>

namespace quadedge::data {

/// \throws DataError with the system's reason when write_atomically() could not put a file here: to ask before long
/// work.
void check_writable(const std::string& path);

/// Writes to a temporary name in the same folder and renames, so that a reader never sees half a file and a failure
/// leaves an older file as it was. Devices and pipes are written directly. \throws DataError with the system's reason.
void write_atomically(const std::string& path, std::string_view bytes);

}  // namespace quadedge::data
