#pragma once
/// \file config.hpp  Every constant of the method as a field with its default. Angles are in degrees; NAME_rad() gives
/// radians.
///
/// constants.inc declares them. Options (`--stereo.ncc_min 0.5`) and keys of `--config FILE.toml` have the same names;
/// doc/configuration.md lists all with unit, range and meaning. quadedge/config_file.hpp reads and writes files.

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "quadedge/pi.hpp"

namespace quadedge {

// EdgesConfig, PatchesConfig, SiftConfig, StereoConfig, TemporalConfig, PoseConfig and OdometryConfig:
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
#include "quadedge/constants.inc"
  std::map<std::string, std::string> variants;  ///< stage -> kernel variant; a missing stage takes the device's default
};

/// A pointer to one field of a Config.
using ConfigField = std::variant<double*, int*, bool*, std::uint64_t*, std::string*>;

/// What is known of one constant.
struct Constant {
  std::string section;               ///< "stereo"; empty for the seed
  std::string name;                  ///< "ncc_min"
  double low, high;                  ///< allowed values of numbers; `high` may be infinite
  std::vector<std::string> choices;  ///< allowed words of texts
  std::string unit;                  ///< "px"; empty for plain numbers
  bool basic;                        ///< most users need no others
  std::string help;                  ///< one line
  std::string paper;                 ///< section of the paper, and its value if another one; may be empty
  ConfigField (*field)(Config& config);

  /// "stereo.ncc_min": the name of the option and of the key in config.toml.
  std::string key() const { return section.empty() ? name : section + "." + name; }
  /// Value in `config` as a text: numbers as short as they read back the same.
  std::string text(const Config& config) const;
  /// What is allowed: "0.01 to 1", "at least 0", "subpixel, cell", "true, false".
  std::string allowed() const;
  /// \throws UsageError that names the constant, its value in `config` and what is allowed, if it is something else.
  void check(const Config& config) const;
};

/// A group of constants.
struct ConstantSection {
  std::string name;    ///< "stereo"
  std::string title;   ///< "Stereo cascade"
  int method_section;  ///< of doc/method.md
};

/// All constants in the order of constants.inc.
const std::vector<Constant>& constants();

/// All sections in that order.
const std::vector<ConstantSection>& constant_sections();

/// \throws UsageError that names the first constant out of its range, its value and the range.
void check_config(const Config& config);

}  // namespace quadedge
