#pragma once
/// \file geometry_cases.hpp  The table of attacks on the geometry. A new one is a row in geometry_cases.cpp.

#include <string>
#include <vector>

#include "attack_sequence.hpp"

namespace attack {

/// What a case asks for.
enum class Demand {
  sound,  ///< all steps are right, and nothing is said
  right,  ///< no step is wrong, and most are right; a warning does no harm
  told,   ///< no step is wrong unless the run says so
  scale,  ///< wrong by a scale that no image can tell; counted apart
};

constexpr int kSolved = -1;
/// Steps by which an open row may differ on another processor: which of two motions wins hangs on little there.
constexpr int kChance = 2;

/// One attack.
struct GeometryCase {
  std::string name;
  Demand demand;
  Sequence (*source)();  ///< empty where the data is not there
  Alteration alteration;
  /// Of an open fault, whose demand is not met: so many steps are wrong without a word. More of them fail the test.
  int open = kSolved;
};

const std::vector<GeometryCase>& geometry_cases();

/// What became of the steps between consecutive frames of a run.
struct Verdict {
  int right = 0;
  int wrong = 0;   ///< without a word
  int warned = 0;  ///< wrong in a run that says that something is doubtful, or in a frame that says so
  int lost = 0;
  bool has_warning = false;
  std::string words;  ///< the first thing that was said
};

/// A step is right within 5 mm + 20 % of the true motion and 0.3 degrees + 20 % of the true rotation.
Verdict judge(const Sequence& sequence, const std::string& device, bool print_evidence = false);

/// Does the verdict meet the demand?
bool is_met(Demand demand, const Verdict& verdict);

}  // namespace attack
