#pragma once
/// \file rig_check.hpp  Whether the images of a data set belong to its calibration.

#include "quadedge/dataset.hpp"

namespace quadedge::cli {

/// Asks the first, the middle and the last frame: adds a fact for each, and what speaks against the calibration, and
/// numbers of it that hardly any rig has, to the warnings.
void check_rig_evidence(const Dataset& dataset, DatasetCheck& check);

}  // namespace quadedge::cli
