#pragma once
/// \file rig_learning.hpp  Learns the calibration of a rig from a dataset: `calibrate` and `run --calibrate`.

#include "cli/processes.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/drive_calibration.hpp"

namespace quadedge::cli {

/// How much of a recording is read.
struct LearningLimits {
  int frames = 300;      ///< of files: evenly spread stretches of so many frames in all
  int enough_pairs = 0;  ///< from the start on, until so many pairs of frames are found; 0: all stretches
  bool has_k3 = true;    ///< whether k3 of Brown's lenses is learned
};

/// Reads frames and learns from them, with progress. A signal ends the process. \throws DataError for a frame that
/// cannot be read
DriveCalibration learn_rig(const Dataset& dataset, const LearningLimits& limits, bool quiet,
                           const Interruption& interruption);

}  // namespace quadedge::cli
