#pragma once
/// \file rig_check.hpp  Whether the images of a data set belong to its calibration.

#include <optional>

#include "quadedge/dataset.hpp"

namespace quadedge::cli {

/// Numbers of the calibration that hardly any rig has become warnings.
void check_numbers(const StereoRig& rig, DatasetCheck& check);

/// Asks one frame: adds a fact, and what speaks against the calibration to the warnings.
void check_rig_evidence(const Dataset& dataset, const StereoPair& pair, DatasetCheck& check);

/// Asks the first, the middle and the last frame of a data set of files, and checks the numbers.
void check_rig_evidence(const Dataset& dataset, DatasetCheck& check);

/// The same over pairs that come one by one. Where their number is unknown there is no middle.
class RigEvidenceCollector {
 public:
  void see(const Dataset& dataset, const StereoPair& pair);
  /// What the pairs are of, without them. After at least one.
  const Dataset& dataset() const { return dataset_.value(); }
  /// Adds what was found. To be called once.
  void finish(DatasetCheck& check);

 private:
  DatasetCheck found_;
  std::optional<Dataset> dataset_;
  std::optional<StereoPair> last_;
};

}  // namespace quadedge::cli
