#include "report/config_toml.hpp"

#include <cstdio>
#include <cstdlib>
#include <variant>

namespace quadedge::report {
namespace {

/// Shortest decimal text that reads back as the same number.
std::string format(double value) {
  char text[40];
  for (int digits = 6; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  return text;
}
std::string format(int value) { return std::to_string(value); }
std::string format(std::uint64_t value) { return std::to_string(value); }
std::string format(bool value) { return value ? "true" : "false"; }
std::string format(const std::string& value) { return "\"" + value + "\""; }

}  // namespace

std::string config_toml(const Config& config, const std::string& device) {
  std::string top =
      "# Effective configuration; `quadedge run PATH --config FILE` reads it again.\ndevice = " + format(device) + "\n";
  std::string sections, section;
  Config copy = config;  // visit_config hands out pointers that may write
  visit_config(copy, [&](const std::string& name, ConfigField field, const std::string& help, double, double) {
    const std::string value = std::visit([](const auto* pointer) { return format(*pointer); }, field);
    const auto dot = name.find('.');
    if (dot == std::string::npos) {
      top += name + " = " + value + "  # " + help + "\n";
      return;
    }
    if (name.substr(0, dot) != section) {
      section = name.substr(0, dot);
      sections += "\n[" + section + "]\n";
    }
    sections += name.substr(dot + 1) + " = " + value + "  # " + help + "\n";
  });
  if (!config.variants.empty()) {
    top += "variant = [";
    const char* separator = "";
    for (const auto& [stage, variant] : config.variants) {
      top += separator + format(stage + "=" + variant);
      separator = ", ";
    }
    top += "]\n";
  }
  return top + sections;
}

}  // namespace quadedge::report
