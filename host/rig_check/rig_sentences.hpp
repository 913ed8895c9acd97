#pragma once
/// \file rig_sentences.hpp  Findings about a rig in words: what was measured, and the likely cause.

#include <string>

#include "quadedge/warning.hpp"
#include "rig_check/rig_finding.hpp"

namespace quadedge::rig_check {

/// One sentence for the user.
std::string sentence(const RigFinding& finding);

/// The warning for a finding that is not a mismatch.
Warning warning(const RigFinding& finding);

}  // namespace quadedge::rig_check
