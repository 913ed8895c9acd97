#pragma once
/// \file command_line.hpp  What the user typed; results say which command they come from.

#include <string>

namespace quadedge::cli {

/// The command line of this process as it was typed, the program itself named quadedge.
std::string command_line();

}  // namespace quadedge::cli
