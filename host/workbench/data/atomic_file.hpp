#pragma once
/// \file atomic_file.hpp  Output files, written completely or not at all, and the folders of a user.

#include <filesystem>
#include <string>
#include <string_view>

namespace quadedge::data {

/// Checks, before long work, that write_atomically() can put a file here. \throws DataError with the system's reason
void check_writable(const std::string& path);

/// Makes a folder and those above it. \throws DataError with the system's reason
void make_folder(const std::filesystem::path& path);

/// Removes a file, or a folder with all in it, if there is one. \throws DataError with the system's reason
void remove_all(const std::filesystem::path& path);

/// Writes to a temporary name in the same folder and renames it, so that readers never see an incomplete file and a
/// failure leaves an existing file unchanged. Devices and pipes are written directly. \throws DataError with the
/// system's reason
void write_atomically(const std::string& path, std::string_view bytes);

// Folders for a user's configuration and cache (XDG Base Directory Specification).

/// $XDG_CONFIG_HOME/quadedge, or ~/.config/quadedge if that is not set; empty if neither is known.
std::string configuration_folder();

/// $XDG_CACHE_HOME/quadedge, or ~/.cache/quadedge if that is not set; empty if neither is known.
std::string cache_folder();

}  // namespace quadedge::data
