#pragma once
/// \file geometry_cases.hpp  The table of attacks on the geometry. To add one, add a row in geometry_cases.cpp.

#include <string>
#include <vector>

#include "attack_sequence.hpp"

namespace attack {

/// What a case requires.
enum class Demand {
  sound,      ///< all steps are right, without a warning
  right,      ///< no step is wrong, and most are right; warnings are allowed
  blameless,  ///< the same, and no warning blames the calibration
  reported,   ///< no step is wrong without a warning
  scale,      ///< wrong by a scale that images cannot reveal; counted separately
};

constexpr int kSolved = -1;
/// Steps by which an open row may differ on another processor, since a small difference decides between two motions.
constexpr int kChance = 2;

/// One attack.
struct GeometryCase {
  std::string name;
  Demand demand;
  Sequence (*source)();  ///< empty if the data is missing
  Alteration alteration;
  /// For a known fault whose demand is not met: the number of steps that are wrong without a warning. More fail the
  /// test.
  int open = kSolved;
};

const std::vector<GeometryCase>& geometry_cases();

/// The outcome of the steps between consecutive frames of a run.
struct Verdict {
  int right = 0;
  int wrong = 0;   ///< without a warning
  int warned = 0;  ///< wrong in a run with a warning, or in a flagged frame
  int lost = 0;
  bool has_warning = false;
  bool blames_calibration = false;
  std::string words;  ///< the first message or warning
};

/// A step is right within 5 mm + 20 % of the true motion and 0.3 degrees + 20 % of the true rotation.
Verdict judge(const Sequence& sequence, const std::string& device, bool print_evidence = false);

/// Whether the verdict meets the demand.
bool is_met(Demand demand, const Verdict& verdict);

}  // namespace attack
