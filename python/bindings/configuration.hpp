#pragma once
/// \file configuration.hpp  Presets and configurations as Python gives them.

#include <string>

#include "bindings.hpp"
#include "quadedge/config.hpp"

namespace quadedge::python {

/// A preset with what `config` says beyond it: a dictionary of keys, the path of a TOML file, or None.
/// \throws UsageError for an unknown preset or key, a value of another type or out of its range; TypeError.
Config make_config(const std::string& preset, nb::handle config);

/// Every constant by its key, and "variant" where one is chosen.
nb::dict to_dict(const Config& config);

}  // namespace quadedge::python
