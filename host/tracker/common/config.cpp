/// \file config.cpp  The list of constants, generated from quadedge/constants.inc, and their range checks.
#include "quadedge/config.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "common/printed.hpp"
#include "quadedge/error.hpp"

namespace quadedge {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr double kLargestInt = std::numeric_limits<int>::max();
constexpr double kLargestSeed = 9007199254740992;  // 2^53: exact as a double and as an integer in TOML and JSON
constexpr double kLeastMagnitude = 1e-9;
enum Level : bool { advanced = false, basic = true };

template <class T>
std::string number(T value) {
  char text[40];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

std::string text_of(double value) { return number(value); }
std::string text_of(int value) { return number(value); }
std::string text_of(std::uint64_t value) { return number(value); }
std::string text_of(bool value) { return value ? "true" : "false"; }
std::string text_of(const std::string& value) { return value; }

/// Text of a bound; integers without an exponent.
std::string bound(double value) {
  return std::abs(value) >= 1e5 && value == std::floor(value) ? number(static_cast<std::int64_t>(value))
                                                              : number(value);
}

/// Pointer to a field that is only read.
ConfigField read_only(const Constant& constant, const Config& config) {
  return constant.field(const_cast<Config&>(config));
}

std::vector<Constant> list_constants() {
  std::vector<Constant> list;
  std::string section;
#define QUADEDGE_TOP_CONSTANT(type, name, value, low, high, unit, level, help, paper)                     \
  list.push_back({"", #name, low, high, {}, unit, level, help, paper, [](Config& config) -> ConfigField { \
                    return &config.name;                                                                  \
                  }});
#define QUADEDGE_WORDS(...) __VA_ARGS__
#define QUADEDGE_TOP_CHOICE(name, value, choices, level, help, paper)              \
  list.push_back({"", #name, 0, 0, QUADEDGE_WORDS choices, "", level, help, paper, \
                  [](Config& config) -> ConfigField { return &config.name; }});
#define QUADEDGE_SECTION(Type, name, title, page)      \
  {                                                    \
    constexpr Type Config::*in_config = &Config::name; \
    section = #name;
#define QUADEDGE_CONSTANT(type, name, value, low, high, unit, level, help, paper)                              \
  list.push_back({section, #name, low, high, {}, unit, level, help, paper, [](Config& config) -> ConfigField { \
                    return &(config.*in_config).name;                                                          \
                  }});
#define QUADEDGE_ANGLE(name, value, low, high, level, help, paper) \
  QUADEDGE_CONSTANT(double, name, value, low, high, "deg", level, help, paper)
#define QUADEDGE_SWITCH(name, value, level, help, paper) \
  QUADEDGE_CONSTANT(bool, name, value, 0, 1, "", level, help, paper)
#define QUADEDGE_CHOICE(name, value, choices, level, help, paper)                       \
  list.push_back({section, #name, 0, 0, QUADEDGE_WORDS choices, "", level, help, paper, \
                  [](Config& config) -> ConfigField { return &(config.*in_config).name; }});
#define QUADEDGE_END_SECTION }
#include "quadedge/constants.inc"
  return list;
}

}  // namespace

std::string Constant::text(const Config& config) const {
  return std::visit([](const auto* value) { return text_of(*value); }, read_only(*this, config));
}

std::string Constant::allowed() const {
  const Config config;
  const ConfigField kind = read_only(*this, config);
  if (std::holds_alternative<bool*>(kind)) return "true, false";
  if (!choices.empty()) return joined(choices);
  const bool bounded = std::isfinite(high) && !(std::holds_alternative<int*>(kind) && high == kLargestInt);
  return bounded ? bound(low) + " to " + bound(high) : "at least " + bound(low);
}

void Constant::check(const Config& config) const {
  const ConfigField value = read_only(*this, config);
  const auto within = [&](double number) { return std::isfinite(number) && number >= low && number <= high; };
  const auto* tiny = std::get_if<double*>(&value);  // squares and inverses of smaller numbers are 0 or infinite
  if (tiny != nullptr && **tiny != 0 && std::abs(**tiny) < kLeastMagnitude)
    throw UsageError(key() + " is " + text(config) + "; allowed: 0, and magnitudes of at least " +
                     text_of(kLeastMagnitude));
  bool fine = true;
  if (const auto* real = std::get_if<double*>(&value)) fine = within(**real);
  if (const auto* whole = std::get_if<int*>(&value)) fine = within(**whole);
  if (const auto* natural = std::get_if<std::uint64_t*>(&value)) fine = **natural <= static_cast<std::uint64_t>(high);
  if (const auto* word = std::get_if<std::string*>(&value)) {
    fine = std::find(choices.begin(), choices.end(), **word) != choices.end();
  }
  if (!fine) throw UsageError(key() + " is " + text(config) + "; allowed: " + allowed());
}

const std::vector<Constant>& constants() {
  static const std::vector<Constant> all = list_constants();
  return all;
}

const std::vector<ConstantSection>& constant_sections() {
  static const std::vector<ConstantSection> all = {
#define QUADEDGE_SECTION(Type, name, title, page) {#name, title, page},
#include "quadedge/constants.inc"
  };
  return all;
}

void check_config(const Config& config) {
  for (const Constant& constant : constants()) constant.check(config);
}

}  // namespace quadedge
