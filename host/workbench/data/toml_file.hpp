#pragma once
/// \file toml_file.hpp  TOML files as lists of keys with values. Only toml_file.cpp includes toml++. Error messages
/// state file, line, key, what was found and what was expected. Presets are such files, embedded in the program.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace quadedge::data {

/// A key of a TOML file and its value.
struct TomlEntry {
  std::string file;
  std::size_t line = 0;  ///< from 1
  std::string key;       ///< including its tables: "stereo.ncc_min"
  std::string found;     ///< the value, for messages: "the boolean true"
  /// std::monostate for types that no option uses: dates, arrays of anything except strings.
  std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<std::string>> value;
};

/// All keys of a file, in the order of its lines. \throws UsageError for a file that cannot be read, is longer than 1
/// MB, is not TOML, or contains a key twice
std::vector<TomlEntry> read_toml(const std::string& file);
/// The same for a text; messages refer to it as `name`.
std::vector<TomlEntry> read_toml_text(const std::string& text, const std::string& name);

/// \throws UsageError "FILE:LINE: KEY: expected EXPECTED, found ...".
[[noreturn]] void refuse(const TomlEntry& entry, const std::string& expected);

/// \throws UsageError "FILE:LINE: unknown key 'KEY'", with the most similar of the known ones.
[[noreturn]] void refuse_key(const TomlEntry& entry, const std::vector<std::string>& known);

/// Sets `value` from the entry; integers are accepted as numbers. \throws UsageError for a value of another type
void assign(const TomlEntry& entry, double& value);
void assign(const TomlEntry& entry, int& value);
void assign(const TomlEntry& entry, std::uint64_t& value);
void assign(const TomlEntry& entry, bool& value);
void assign(const TomlEntry& entry, std::string& value);
void assign(const TomlEntry& entry, std::vector<std::string>& value);

/// A value in TOML notation, on one line; numbers read back as the same value.
std::string toml_text(double value);
std::string toml_text(int value);
std::string toml_text(std::uint64_t value);
std::string toml_text(bool value);
std::string toml_text(const std::string& value);
std::string toml_text(const std::vector<std::string>& value);
std::string toml_text(const std::vector<double>& value);

// Presets: named configuration files of config/, embedded in the program.

struct Preset {
  std::string name;
  std::string text;  ///< TOML
};

/// By the number of edges.
const std::vector<Preset>& presets();

std::vector<std::string> preset_names();

/// The entries of a preset; messages refer to it as "preset NAME". \throws UsageError for an unknown name
std::vector<TomlEntry> read_preset(const std::string& name);

}  // namespace quadedge::data
