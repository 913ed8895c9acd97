#pragma once
/// \file user_folder.hpp  Folders for a user's configuration and cache (XDG Base Directory Specification).

#include <string>

namespace quadedge::data {

/// $XDG_CONFIG_HOME/quadedge, or ~/.config/quadedge if that is not set; empty if neither is known.
std::string configuration_folder();

/// $XDG_CACHE_HOME/quadedge, or ~/.cache/quadedge if that is not set; empty if neither is known.
std::string cache_folder();

}  // namespace quadedge::data
