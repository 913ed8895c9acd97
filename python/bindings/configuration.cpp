/// \file configuration.cpp  Turns a dict into TOML text, so that it is read and checked like a file.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arguments.hpp"
#include "quadedge/config.hpp"
#include "quadedge/error.hpp"

namespace quadedge::python {
namespace {

/// A value as JSON writes it, which is TOML. \throws TypeError for what JSON does not have.
std::string toml_value(const std::string& key, nb::handle value) {
  if (value.is_none()) {
    throw nb::type_error(("config: " + key + " is NoneType, expected a number, a string, True or False").c_str());
  }
  const nb::object index = nb::module_::import_("operator").attr("index");  // for whole numbers of numpy
  return nb::cast<std::string>(
      nb::module_::import_("json").attr("dumps")(value, "ensure_ascii"_a = false, "default"_a = index));
}

bool is_bare(const std::string& key) {
  return !key.empty() && key.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_.") == std::string::npos &&
         key.front() != '.' && key.back() != '.' && key.find("..") == std::string::npos;
}

Config with_dict(const nb::dict& config, const Config& base) {
  std::string text;
  for (const auto& [name, value] : config) {
    if (!nb::isinstance<nb::str>(name)) throw nb::type_error("config: expected strings as keys");
    const auto key = nb::cast<std::string>(name);
    if (key == "device") throw UsageError("config: the device is a separate argument, device=");
    text += (is_bare(key) ? key : toml_value(key, name)) + " = " + toml_value(key, value) + "\n";
  }
  return read_config_text(text, "config", base);
}

}  // namespace

Config make_config(const std::string& preset, nb::handle config) {
  const Config base = read_preset(preset);
  if (config.is_none()) return base;
  if (nb::isinstance<nb::dict>(config)) return with_dict(nb::borrow<nb::dict>(config), base);
  const nb::object path = nb::module_::import_("os").attr("fspath")(config);
  return read_config(nb::cast<std::string>(nb::str(path)), base);
}

nb::dict to_dict(const Config& config) {
  nb::dict all;
  Config copy = config;  // field() returns a mutable pointer
  for (const Constant& constant : constants()) {
    std::visit([&](const auto* value) { all[nb::str(constant.key().c_str())] = nb::cast(*value); },
               constant.field(copy));
  }
  nb::list variants;
  for (const auto& [stage, name] : config.variants) variants.append(stage + "=" + name);
  if (nb::len(variants) > 0) all["variant"] = variants;
  return all;
}

void bind_configuration(nb::module_& module) {
  module.def("presets", &preset_names, "Values of ``preset=``, by the number of edges.");
  module.def(
      "configuration",
      [](const std::string& preset, nb::handle config) { return to_dict(make_config(preset, config)); },
      "preset"_a = "default", "config"_a = nb::none(),
      "All configuration values by key (doc/configuration.md), as set by a preset and ``config``.\n\n"
      "preset: one of ``presets()``. config: values that differ from the preset, as a dictionary such as\n"
      "``{\"stereo.max_disparity\": 100}``, or the path of a TOML file, such as the config.toml of a run.\n\n"
      "Raises UsageError that names an unknown key or preset, or a value out of range, and TypeError for values of\n"
      "another type.");
}

}  // namespace quadedge::python
