#pragma once
/// \file configuration.hpp  Presets and configurations as arguments.

#include <string>

#include "bindings.hpp"
#include "quadedge/config.hpp"

namespace quadedge::python {

/// A preset with the values of `config`: a dictionary, the path of a TOML file, or None.
/// \throws UsageError for an unknown preset or key and for a value of another type or out of range; TypeError.
Config make_config(const std::string& preset, nb::handle config);

/// All values by key, and "variant" where kernel variants are chosen.
nb::dict to_dict(const Config& config);

}  // namespace quadedge::python
