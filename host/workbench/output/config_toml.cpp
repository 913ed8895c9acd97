/// \file config_toml.cpp  Walks the list of constants; a value is tried on a copy and checked before it is taken.
#include "output/config_toml.hpp"

#include <algorithm>
#include <utility>

#include "common/nearest_word.hpp"
#include "data/atomic_file.hpp"
#include "quadedge/error.hpp"

namespace quadedge {
namespace {

/// "key = value  # help"; the key without its section.
std::string line_of(const Constant& constant, Config& config) {
  const std::string value =
      std::visit([](const auto* field) { return data::toml_text(*field); }, constant.field(config));
  return constant.name + " = " + value + "  # " + constant.help +
         (constant.unit.empty() ? "" : " [" + constant.unit + "]") + "\n";
}

Config with_entries(const std::vector<data::TomlEntry>& entries, Config config) {
  const auto& all = constants();
  for (const auto& entry : entries) {
    const auto named = [&](const Constant& constant) { return constant.key() == entry.key; };
    const auto constant = std::find_if(all.begin(), all.end(), named);
    if (constant != all.end()) {
      report::set_constant(entry, *constant, config);
    } else if (entry.key == "variant") {
      std::vector<std::string> choices;
      data::assign(entry, choices);
      try {
        for (const auto& choice : choices) report::add_variant(choice, config);
      } catch (const UsageError&) {
        data::refuse(entry, "texts of the form STAGE=NAME");
      }
    } else if (entry.key != "device") {
      std::vector<std::string> keys{"variant", "device"};
      for (const auto& known : all) keys.push_back(known.key());
      data::refuse_key(entry, keys);
    }
  }
  return config;
}

}  // namespace

namespace report {

std::string config_toml(const Config& config, const std::string& device) {
  std::string top = "# Effective configuration; `quadedge run PATH --config FILE` reads it again.\n";
  if (!device.empty()) top += "device = " + data::toml_text(device) + "\n";
  std::string sections, section;
  Config copy = config;  // a constant's field can be written, too
  for (const Constant& constant : constants()) {
    if (constant.section != section) sections += "\n[" + constant.section + "]\n";
    section = constant.section;
    (section.empty() ? top : sections) += line_of(constant, copy);
  }
  std::vector<std::string> variants;
  for (const auto& [stage, variant] : config.variants) variants.push_back(stage + "=" + variant);
  if (!variants.empty()) top += "variant = " + data::toml_text(variants) + "\n";
  return top + sections;
}

void set_constant(const data::TomlEntry& entry, const Constant& constant, Config& config) {
  Config tried = config;
  std::visit([&](auto* field) { data::assign(entry, *field); }, constant.field(tried));
  try {
    constant.check(tried);
  } catch (const UsageError&) {
    data::refuse(entry, constant.allowed());
  }
  config = std::move(tried);
}

void add_variant(const std::string& choice, Config& config) {
  const auto equals = choice.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw UsageError("variant " + choice + ": expected STAGE=NAME as `quadedge variants` lists them");
  }
  config.variants[choice.substr(0, equals)] = choice.substr(equals + 1);
}

}  // namespace report

Config read_config(const std::string& file, const Config& base) { return with_entries(data::read_toml(file), base); }

Config read_config_text(const std::string& text, const std::string& name, const Config& base) {
  return with_entries(data::read_toml_text(text, name), base);
}

std::vector<std::string> preset_names() { return data::preset_names(); }

Config read_preset(const std::string& name) { return with_entries(data::read_preset(name), {}); }

void write_config(const std::string& file, const Config& config) {
  check_config(config);
  data::write_atomically(file, report::config_toml(config, ""));
}

}  // namespace quadedge
