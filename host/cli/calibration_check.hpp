#pragma once
/// \file calibration_check.hpp  Whether the images of a dataset fit its calibration.

#include <optional>

#include "quadedge/calibration.hpp"
#include "quadedge/dataset.hpp"
#include "rig/row_model.hpp"

namespace quadedge::cli {

/// Adds a warning for each implausible value of the calibration.
void check_numbers(const StereoRig& rig, DatasetCheck& check);

/// A sentence that proposes --rectified, if a pair fits the cameras of rectified images better than those that record;
/// otherwise empty.
std::string rectified_proposal(const Dataset& dataset, const StereoPair& pair);

/// Tests the calibration on one frame: adds the figures, and warnings where it does not fit.
void check_rig_evidence(const Dataset& dataset, const StereoPair& pair, DatasetCheck& check);

/// What some frames of a dataset show of its right camera's rows.
class RowEvidence {
 public:
  /// Whether a frame of `frames` (0: unknown) is one of those that are examined.
  static bool wants(int frame, std::size_t frames);
  void see(const StereoRig& rig, const StereoPair& pair);
  /// Adds what was found as a fact. \returns the calibration with what is certain
  StereoCalibration finish(const Dataset& dataset, DatasetCheck& check) const;

 private:
  std::optional<rig::RowModel> rows_;
};

/// Tests the first, the middle and the last frame of a dataset of files, the values of the calibration, and the rows of
/// some frames. \returns the corrected calibration
StereoCalibration check_rig_evidence(const Dataset& dataset, DatasetCheck& check);

/// The same for pairs that arrive one by one. Without a known number of pairs there is no middle one.
class RigEvidenceCollector {
 public:
  void see(const Dataset& dataset, const StereoPair& pair);
  /// The dataset of the pairs, without its stream. Valid after the first see().
  const Dataset& dataset() const { return dataset_.value(); }
  /// Adds the findings. To be called once. \returns the corrected calibration
  StereoCalibration finish(DatasetCheck& check);

 private:
  DatasetCheck found_;
  std::optional<Dataset> dataset_;
  std::optional<StereoPair> last_;
  RowEvidence rows_;
};

}  // namespace quadedge::cli
