#pragma once
/// \file toml_file.hpp  TOML files as a list of keys with values, by toml++; toml_file.cpp is the only file that
/// includes it. Every complaint names file, line, key, what was found and what was expected.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace quadedge::data {

/// A key of a TOML file with its value.
struct TomlEntry {
  std::string file;
  std::size_t line = 0;  ///< from 1
  std::string key;       ///< with its tables: "stereo.ncc_min"
  std::string found;     ///< the value for a message: "the boolean true"
  /// std::monostate for what no option takes: dates, arrays of anything but strings.
  std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<std::string>> value;
};

/// All keys of a file in the order of its lines. \throws UsageError for a file that cannot be read, is longer than
/// 1 MB, is no TOML, or gives a key twice.
std::vector<TomlEntry> read_toml(const std::string& file);
/// The same of a text; complaints call it `name`.
std::vector<TomlEntry> read_toml_text(const std::string& text, const std::string& name);

/// \throws UsageError "FILE:LINE: KEY: expected EXPECTED, found ...".
[[noreturn]] void refuse(const TomlEntry& entry, const std::string& expected);

/// \throws UsageError "FILE:LINE: unknown key 'KEY'", with the most similar of the known ones.
[[noreturn]] void refuse_key(const TomlEntry& entry, const std::vector<std::string>& known);

/// Sets `value` to that of the entry; a whole number is a number, too. \throws UsageError for a value of another type.
void assign(const TomlEntry& entry, double& value);
void assign(const TomlEntry& entry, int& value);
void assign(const TomlEntry& entry, std::uint64_t& value);
void assign(const TomlEntry& entry, bool& value);
void assign(const TomlEntry& entry, std::string& value);
void assign(const TomlEntry& entry, std::vector<std::string>& value);

/// A value as TOML writes it, on one line; numbers read back as the same.
std::string toml_text(double value);
std::string toml_text(int value);
std::string toml_text(std::uint64_t value);
std::string toml_text(bool value);
std::string toml_text(const std::string& value);
std::string toml_text(const std::vector<std::string>& value);

}  // namespace quadedge::data
