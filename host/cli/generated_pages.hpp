#pragma once
/// \file generated_pages.hpp  Texts made from what the commands declare: manual page, shell completion, configuration
/// page.

#include <string>
#include <vector>

#include "cli/described_command.hpp"

namespace quadedge::cli {

/// quadedge.1 in the man macros of troff.
std::string manual_page(const std::vector<DescribedCommand>& commands);

/// Completion of commands, options and their words for bash.
std::string bash_completion(const std::vector<DescribedCommand>& commands);

/// doc/configuration.md: a table of all constants.
std::string configuration_page();

/// host/frontend/self_test.rows: two small rendered frames, and what the plain C++ reference makes of them.
std::string self_test_page();

}  // namespace quadedge::cli
