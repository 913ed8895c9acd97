#pragma once
/// \file parser.hpp  The command line: finds the command and sets its options.

#include <memory>
#include <vector>

#include "cli/command.hpp"

namespace quadedge::cli {

/// What the command line asks for: a command to run, or (command == nullptr) to end with `exit_code`.
struct Parsed {
  Command* command = nullptr;
  int exit_code = 0;
};

/// Parses the command line. Help and version go to stdout, errors to stderr with exit code 2.
/// \throws UsageError for a configuration file that cannot be read or holds an unknown key.
Parsed parse_command_line(int argc, char** argv, const std::vector<std::unique_ptr<Command>>& commands);

}  // namespace quadedge::cli
