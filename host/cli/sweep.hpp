#pragma once
/// \file sweep.hpp  One constant of the method over a range of values.

#include <string>
#include <vector>

#include "quadedge/config.hpp"

namespace quadedge::cli {

/// What `--sweep SECTION.FIELD=FIRST:LAST:STEP` asks for.
struct Sweep {
  std::string key;
  std::vector<double> values;        ///< FIRST, FIRST + STEP, ... up to LAST
  std::vector<int> stereo_orders;    ///< rows of Table 1 that the constant affects, and the last one
  std::vector<int> temporal_orders;  ///< rows of Table 2
};

/// \throws UsageError for malformed text, an unknown key, or a constant that is not a number.
Sweep parse_sweep(const std::string& text);

/// The configuration with one constant changed. \throws UsageError for a value out of its range.
Config with_value(Config config, const std::string& key, double value);

}  // namespace quadedge::cli
