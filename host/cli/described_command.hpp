#pragma once
/// \file described_command.hpp  A command and its options as data, for the manual page and the shell completion.

#include <string>
#include <vector>

#include "cli/command.hpp"

namespace quadedge::cli {

/// One option or positional argument.
struct DescribedOption {
  std::vector<std::string> names;  ///< "-o", "--output"; of a positional argument its name in capitals
  std::string placeholder;         ///< "FILE"; empty for a flag
  std::string help;
  std::string default_text;          ///< empty: not shown
  std::string heading;               ///< of its group
  std::string environment;           ///< variable that sets the default
  std::vector<std::string> choices;  ///< allowed words; empty: any text
  bool positional = false;
  bool required = false;
  bool repeated = false;
  bool is_constant = false;  ///< a constant of the method, shared by all computing commands
};

struct DescribedCommand {
  std::string name;  ///< "evaluate trajectory"
  std::string about;
  std::string examples;
  std::vector<DescribedOption> options;
};

/// Lists the options that a command declares.
DescribedCommand describe(Command& command);

}  // namespace quadedge::cli
