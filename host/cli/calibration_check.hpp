#pragma once
/// \file calibration_check.hpp  Whether the images of a dataset fit its calibration.

#include <optional>

#include "quadedge/dataset.hpp"

namespace quadedge::cli {

/// Adds a warning for each implausible value of the calibration.
void check_numbers(const StereoRig& rig, DatasetCheck& check);

/// A sentence that proposes --rectified, if a pair fits the cameras of rectified images better than those that record;
/// otherwise empty.
std::string rectified_proposal(const Dataset& dataset, const StereoPair& pair);

/// Tests the calibration on one frame: adds the figures, and warnings where it does not fit.
void check_rig_evidence(const Dataset& dataset, const StereoPair& pair, DatasetCheck& check);

/// Tests the first, the middle and the last frame of a dataset of files, and the values of the calibration.
void check_rig_evidence(const Dataset& dataset, DatasetCheck& check);

/// The same for pairs that arrive one by one. Without a known number of pairs there is no middle one.
class RigEvidenceCollector {
 public:
  void see(const Dataset& dataset, const StereoPair& pair);
  /// The dataset of the pairs, without its stream. Valid after the first see().
  const Dataset& dataset() const { return dataset_.value(); }
  /// Adds the findings. To be called once.
  void finish(DatasetCheck& check);

 private:
  DatasetCheck found_;
  std::optional<Dataset> dataset_;
  std::optional<StereoPair> last_;
};

}  // namespace quadedge::cli
