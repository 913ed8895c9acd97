#pragma once
/// \file config_toml.hpp  The parts of quadedge/config.hpp that the command line shares.

#include <string>

#include "data/toml_file.hpp"
#include "quadedge/config.hpp"

namespace quadedge::report {

/// Text of config.toml: device, seed, variants, and every constant with its help as a comment.
std::string config_toml(const Config& config, const std::string& device);

/// Sets one constant to an entry's value. \throws UsageError for a wrong type or a value out of the range.
void set_constant(const data::TomlEntry& entry, const Constant& constant, Config& config);

/// Adds "STAGE=NAME" to the variants. \throws UsageError for any other text.
void add_variant(const std::string& choice, Config& config);

}  // namespace quadedge::report
