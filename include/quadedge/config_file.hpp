#pragma once
/// \file config_file.hpp  The configuration as a TOML file, as read by `--config` and written to config.toml by every
/// run. Part of quadedge::quadedge; quadedge::quadedge_core does not read files.

#include <string>
#include <vector>

#include "quadedge/config.hpp"

namespace quadedge {

/// Reads `file` and overrides the values of `base`: `seed`, `variant = ["STAGE=NAME"]` and the constants of
/// doc/configuration.md. The key `device` is skipped; only the program uses it. \throws UsageError that names file,
/// line, key and the expected value: for a file that cannot be read or is not TOML, an unknown key, a wrong type, or a
/// value out of range.
Config read_config(const std::string& file, const Config& base = {});

/// As read_config(), from TOML text; messages refer to it as `name`.
Config read_config_text(const std::string& text, const std::string& name, const Config& base = {});

/// The values of `--preset`, by the number of edges.
std::vector<std::string> preset_names();

/// The defaults, modified by a preset. \throws UsageError for an unknown name.
Config read_preset(const std::string& name);

/// Writes every constant, with its description as a comment. \throws UsageError for a value out of range, DataError if
/// the file cannot be written.
void write_config(const std::string& file, const Config& config);

}  // namespace quadedge
