#pragma once
/// \file user_folder.hpp  Where a user's configuration and kept files are (XDG Base Directory Specification).

#include <string>

namespace quadedge::data {

/// $XDG_CONFIG_HOME/quadedge, or ~/.config/quadedge where that is not set; empty where neither is.
std::string configuration_folder();

/// $XDG_CACHE_HOME/quadedge, or ~/.cache/quadedge where that is not set; empty where neither is.
std::string cache_folder();

}  // namespace quadedge::data
