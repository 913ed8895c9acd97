/// \file toml_file.cpp  Flattens toml++ tables to dotted keys in order of lines; bounds what is parsed beforehand.
#include "data/toml_file.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <locale>
#include <set>
#include <sstream>

#include "common/nearest_word.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"

#define TOML_MAX_NESTED_VALUES 16  // options need at most arrays of strings
#include <toml++/toml.h>

namespace quadedge::data {
namespace {

constexpr std::size_t kMostBytes = 1'000'000,
                      kLongestLine = 4096;  // a dotted key nests in proportion to the length of its line

std::string at_line(const std::string& file, std::size_t line) { return file + ":" + std::to_string(line) + ": "; }

/// Text of the file, limited in length so that parsing it takes bounded time.
std::string bounded_text(const std::string& file) {
  if (const std::string kind = irregular_kind(file); !kind.empty()) {
    throw UsageError(file + ": found " + kind + ", expected a configuration file");
  }
  std::ifstream in(file, std::ios::binary);
  std::string text(kMostBytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!in.is_open() || in.bad()) {
    throw UsageError(file + ": the configuration file cannot be read");
  }
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kMostBytes) throw UsageError(file + ": longer than 1 MB, not a configuration file");
  std::size_t number = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.size() > kLongestLine) {
      throw UsageError(at_line(file, number) + "longer than " + std::to_string(kLongestLine) + " characters");
    }
  }
  return text;
}

/// Sets value and description from a node that is not a table.
void set_value(TomlEntry& entry, const toml::node& node) {
  std::ostringstream found;
  found.imbue(std::locale::classic());
  if (node.is_value()) found << toml::node_view(node);
  entry.found = node.is_array() ? "an array" : found.str();
  if (const auto* truth = node.as_boolean()) entry.value = truth->get();
  if (const auto* number = node.as_integer()) entry.value = number->get();
  if (const auto* real = node.as_floating_point()) entry.value = real->get();
  if (const auto* text = node.as_string()) {
    entry.value = text->get();
    entry.found = in_quotes(text->get());
  }
  if (const auto* array = node.as_array();
      array != nullptr && (array->empty() || array->is_homogeneous<std::string>())) {
    std::vector<std::string> texts;
    for (const auto& element : *array) texts.push_back(element.ref<std::string>());
    entry.value = std::move(texts);
  }
}

void list_entries(const toml::table& table, const std::string& file, const std::string& prefix,
                  std::vector<TomlEntry>& entries) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    if (const auto* inner = node.as_table()) {
      list_entries(*inner, file, name + ".", entries);
      continue;
    }
    TomlEntry& entry = entries.emplace_back();
    entry.file = file;
    entry.line = key.source().begin.line;
    entry.key = name;
    set_value(entry, node);
  }
}

/// The entry's integer. \throws UsageError for another type or a number out of range
std::int64_t whole(const TomlEntry& entry, std::int64_t low, std::int64_t high) {
  const auto* number = std::get_if<std::int64_t>(&entry.value);
  if (number == nullptr || *number < low || *number > high) {
    refuse(entry, "a whole number of " + std::to_string(low) + " to " + std::to_string(high));
  }
  return *number;
}

}  // namespace

std::vector<TomlEntry> read_toml(const std::string& file) { return read_toml_text(bounded_text(file), file); }

std::vector<TomlEntry> read_toml_text(const std::string& text, const std::string& file) {
  toml::table table;
  try {
    table = toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw UsageError(at_line(file, error.source().begin.line) + "not TOML: " + std::string(error.description()));
  }
  std::vector<TomlEntry> entries;
  list_entries(table, file, "", entries);
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.line < b.line; });
  std::set<std::string> keys;
  for (const auto& entry : entries) {
    if (!keys.insert(entry.key).second) {
      throw UsageError(at_line(file, entry.line) + "'" + entry.key + "' is given twice");
    }
  }
  return entries;
}

void refuse(const TomlEntry& entry, const std::string& expected) {
  throw UsageError(at_line(entry.file, entry.line) + entry.key + ": expected " + expected + ", found " + entry.found);
}

void refuse_key(const TomlEntry& entry, const std::vector<std::string>& known) {
  throw UsageError(at_line(entry.file, entry.line) + "unknown key " + in_quotes(entry.key) +
                   did_you_mean(entry.key, known));
}

void assign(const TomlEntry& entry, double& value) {
  if (const auto* real = std::get_if<double>(&entry.value)) {
    value = *real;
  } else if (const auto* number = std::get_if<std::int64_t>(&entry.value)) {
    value = static_cast<double>(*number);
  } else {
    refuse(entry, "a number");
  }
}

void assign(const TomlEntry& entry, int& value) {
  value = static_cast<int>(whole(entry, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
}

void assign(const TomlEntry& entry, std::uint64_t& value) {
  value = static_cast<std::uint64_t>(whole(entry, 0, std::numeric_limits<std::int64_t>::max()));
}

void assign(const TomlEntry& entry, bool& value) {
  const auto* truth = std::get_if<bool>(&entry.value);
  if (truth == nullptr) refuse(entry, "true or false");
  value = *truth;
}

void assign(const TomlEntry& entry, std::string& value) {
  const auto* text = std::get_if<std::string>(&entry.value);
  if (text == nullptr) refuse(entry, "a string in quotes");
  value = *text;
}

void assign(const TomlEntry& entry, std::vector<std::string>& value) {
  if (const auto* text = std::get_if<std::string>(&entry.value)) {
    value = {*text};
  } else if (const auto* texts = std::get_if<std::vector<std::string>>(&entry.value)) {
    value = *texts;
  } else {
    refuse(entry, "an array of strings in quotes");
  }
}

std::string toml_text(double value) {
  char text[40];  // toml++ writes 17 digits even if fewer read back as the same number
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}
std::string toml_text(int value) { return std::to_string(value); }
std::string toml_text(std::uint64_t value) { return std::to_string(value); }
std::string toml_text(bool value) { return value ? "true" : "false"; }
std::string toml_text(const std::string& value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << toml::toml_formatter(toml::value<std::string>(value), toml::format_flags::none);
  return text.str();
}
template <class T>
std::string array_text(const std::vector<T>& value) {
  std::string text;
  for (const T& element : value) text += (text.empty() ? "" : ", ") + toml_text(element);
  return "[" + text + "]";
}
std::string toml_text(const std::vector<std::string>& value) { return array_text(value); }
std::string toml_text(const std::vector<double>& value) { return array_text(value); }

}  // namespace quadedge::data

namespace quadedge::data {

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const auto& preset : presets()) names.push_back(preset.name);
  return names;
}

std::vector<TomlEntry> read_preset(const std::string& name) {
  for (const auto& preset : presets())
    if (preset.name == name) return read_toml_text(preset.text, "preset " + name);
  throw UsageError("there is no preset '" + name + "'" + did_you_mean(name, preset_names()));
}

}  // namespace quadedge::data
