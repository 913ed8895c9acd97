#pragma once
/// \file bounded_folder.hpp  Keeps a cache folder small.

#include <cstdint>
#include <string>

namespace quadedge {

/// Removes the files of a folder whose names end in `suffix` and whose times are the oldest, until the others have at
/// most `bound` bytes. Other processes may do the same; errors are ignored.
void remove_oldest_files(const std::string& folder, const std::string& suffix, std::uintmax_t bound);

}  // namespace quadedge
