#pragma once
/// \file config_file.hpp  The configuration as a TOML file, as `--config` reads it and every run leaves it in
/// config.toml. Part of quadedge::quadedge; quadedge::quadedge_core reads no files.

#include <string>
#include <vector>

#include "quadedge/config.hpp"

namespace quadedge {

/// `base` with what the file says: `seed`, `variant = ["STAGE=NAME"]` and the constants of doc/configuration.md.
/// The key `device` is for the program alone and skipped. \throws UsageError that names file, line, key and what was
/// expected: for a file that cannot be read or is no TOML, an unknown key, a wrong type, a value out of its range.
Config read_config(const std::string& file, const Config& base = {});

/// The same of a TOML text; complaints call it `name`.
Config read_config_text(const std::string& text, const std::string& name, const Config& base = {});

/// What `--preset` takes, from fast to accurate.
std::vector<std::string> preset_names();

/// The defaults with what a preset says. \throws UsageError for an unknown name.
Config read_preset(const std::string& name);

/// Writes every constant, with its meaning as a comment. \throws UsageError for a value out of its range, DataError for
/// a file that cannot be written.
void write_config(const std::string& file, const Config& config);

}  // namespace quadedge
