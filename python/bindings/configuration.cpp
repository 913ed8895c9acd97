/// \file configuration.cpp  Turns a dict into TOML text, so that it is read and checked like a file.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arguments.hpp"
#include "quadedge/config.hpp"
#include "quadedge/error.hpp"

namespace quadedge::python {
namespace {

/// A string as a TOML (and JSON) literal.
std::string quoted(nb::handle text) {
  return nb::cast<std::string>(nb::module_::import_("json").attr("dumps")(text, "ensure_ascii"_a = false));
}

/// A value as a TOML literal. \throws TypeError.
std::string toml_value(const std::string& key, nb::handle value) {
  if (nb::isinstance<nb::bool_>(value)) return nb::cast<bool>(value) ? "true" : "false";
  if (nb::isinstance<nb::str>(value)) return quoted(value);
  if (nb::isinstance<nb::float_>(value)) return nb::cast<std::string>(nb::repr(nb::float_(value)));
  if (PyIndex_Check(value.ptr())) return nb::cast<std::string>(nb::str(nb::int_(value)));
  if (nb::isinstance<nb::list>(value) || nb::isinstance<nb::tuple>(value)) {
    std::string texts;
    for (const auto& element : value) {
      if (!nb::isinstance<nb::str>(element)) throw nb::type_error(("config: " + key + ": expected strings").c_str());
      texts += (texts.empty() ? "" : ", ") + quoted(element);
    }
    return "[" + texts + "]";
  }
  throw nb::type_error(("config: " + key + " is " + nb::cast<std::string>(nb::str(value.type().attr("__name__"))) +
                        ", expected a number, a string, True or False")
                           .c_str());
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
    text += (is_bare(key) ? key : quoted(name)) + " = " + toml_value(key, value) + "\n";
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
