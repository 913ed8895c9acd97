#pragma once
/// \file calibration_check.hpp  Whether the images of a dataset fit its calibration.

#include <optional>

#include "calibration/image_delay.hpp"
#include "quadedge/dataset.hpp"

namespace quadedge::cli {

/// A sentence that proposes --rectified, if a pair fits the cameras of rectified images better than those that record;
/// otherwise empty.
std::string rectified_proposal(const Dataset& dataset, const StereoPair& pair);

/// Tests the values of a calibration, its first, middle and last frame, and the delay of some frames, of pairs
/// that arrive one by one. Without a known number of pairs there is no middle one.
class RigEvidenceCollector {
 public:
  void see(const Dataset& dataset, const StereoPair& pair);
  bool empty() const { return !dataset_; }
  /// The dataset of the pairs, without its stream. Valid after the first see().
  const Dataset& dataset() const { return dataset_.value(); }
  /// Adds the findings. To be called once, after see().
  void finish(DatasetCheck& check);

 private:
  DatasetCheck found_;
  std::optional<Dataset> dataset_;
  std::optional<StereoPair> last_;
  rig::ImageDelaySearch delays_;
};

}  // namespace quadedge::cli
