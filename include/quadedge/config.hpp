#pragma once
/// \file config.hpp  Every constant of the method, as a field with its default. Angles are in degrees; NAME_rad()
/// returns radians.
///
/// constants.inc declares them. Command-line options (`--stereo.ncc_min 0.5`) and keys of `--config FILE.toml` have the
/// same names; doc/configuration.md lists all constants with unit, range and meaning. The functions for
/// files are part of quadedge::quadedge; quadedge::quadedge_core does not read files.

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "quadedge/camera.hpp"

namespace quadedge {

// Defines EdgesConfig, PatchesConfig, StereoConfig, TemporalConfig, PoseConfig,
// OdometryConfig and MapConfig.
#define QUADEDGE_SECTION(Type, section, title, page) struct Type {
#define QUADEDGE_CONSTANT(type, name, value, low, high, unit, level, help, paper) type name = value;
#define QUADEDGE_ANGLE(name, value, low, high, level, help, paper) \
  double name = value;                                             \
  double name##_rad() const { return name * kDegree; }
#define QUADEDGE_SWITCH(name, value, level, help, paper) bool name = value;
#define QUADEDGE_CHOICE(name, value, choices, level, help, paper) std::string name = value;
#define QUADEDGE_END_SECTION \
  }                          \
  ;
#include "quadedge/constants.inc"

/// The whole configuration: one field per section, such as `config.stereo.ncc_min`, and `config.seed`.
struct Config {
#define QUADEDGE_SECTION(Type, section, title, page) Type section;
#define QUADEDGE_TOP_CONSTANT(type, name, value, low, high, unit, level, help, paper) type name = value;
#define QUADEDGE_TOP_CHOICE(name, value, choices, level, help, paper) std::string name = value;
#include "quadedge/constants.inc"
  std::map<std::string, std::string> variants;  ///< stage -> kernel variant; of others, the default of the device

  /// Whether the steps are the paper's (doc/paper.md).
  bool is_paper() const { return method == "paper"; }
};

/// A pointer to one field of a Config.
using ConfigField = std::variant<double*, int*, bool*, std::uint64_t*, std::string*>;

/// Description of one constant.
struct Constant {
  std::string section;               ///< "stereo"; empty for the seed
  std::string name;                  ///< "ncc_min"
  double low, high;                  ///< allowed range of numbers; `high` may be infinite
  std::vector<std::string> choices;  ///< allowed values of strings
  std::string unit;                  ///< "px"; empty for plain numbers
  bool basic;                        ///< whether it is one of the few constants that most users need
  std::string help;                  ///< one-line description
  std::string paper;                 ///< section of the paper, and the paper's value if it differs; may be empty
  ConfigField (*field)(Config& config);

  /// "stereo.ncc_min": name of the option and key in config.toml.
  std::string key() const { return section.empty() ? name : section + "." + name; }
  /// Value in `config` as text: the shortest decimal number that reads back as the same value.
  std::string text(const Config& config) const;
  /// Allowed values: "0.01 to 1", "at least 0", "subpixel, pixel", "true, false".
  std::string allowed() const;
  /// \throws UsageError that names the constant, its value in `config` and the allowed values, if the value is not
  /// allowed.
  void check(const Config& config) const;
};

/// A group of constants.
struct ConstantSection {
  std::string name;    ///< "stereo"
  std::string title;   ///< "Stereo cascade"
  int method_section;  ///< section of doc/method.md that describes the group
};

/// All constants, in the order of constants.inc.
const std::vector<Constant>& constants();

/// All sections, in the order of constants.inc.
const std::vector<ConstantSection>& constant_sections();

/// \throws UsageError that names the first constant that is out of range, its value and its range.
void check_config(const Config& config);

/// Reads `file` and overrides the values of `base`: `seed`, `variant = ["STAGE=NAME"]` and the constants of
/// doc/configuration.md. The key `device` is skipped; only the program uses it. \throws UsageError that names file,
/// line, key and the expected value: for a file that cannot be read or is not TOML, an unknown key, a wrong type, or a
/// value out of range.
Config read_config(const std::string& file, const Config& base = {});

/// As read_config(), from TOML text; messages refer to it as `name`.
Config read_config_text(const std::string& text, const std::string& name, const Config& base = {});

/// The values of `--preset`, by the number of edges.
std::vector<std::string> preset_names();

/// The defaults, modified by a preset. \throws UsageError for an unknown name.
Config read_preset(const std::string& name);

/// Writes every constant, with its description as a comment. \throws UsageError for a value out of range, DataError if
/// the file cannot be written.
void write_config(const std::string& file, const Config& config);

}  // namespace quadedge
