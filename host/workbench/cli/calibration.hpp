#pragma once
/// \file calibration.hpp  Calibrations of recordings: whether the images fit them, learning them (`calibrate` and
/// `run --calibrate`), and writing them for other programs.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.hpp"
#include "cli/processes.hpp"
#include "quadedge/calibration.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/drive_calibration.hpp"
#include "rig/image_delay.hpp"
#include "rig/interlacing.hpp"

namespace quadedge::cli {

/// A sentence that proposes --rectified, if a pair fits the cameras of rectified images better than those that record;
/// otherwise empty.
std::string rectified_proposal(const Dataset& dataset, const StereoPair& pair);

/// Tests the values of a calibration, its first, middle and last frame, and delay and combing of some frames, of
/// pairs that arrive one by one. Without a known number of pairs there is no middle one.
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
  rig::Combing combing_;
};

/// --kalibr, --opencv and --ros of a command.
class CalibrationExport {
 public:
  void declare(Options& options);
  bool empty() const;
  /// Whether k3 of Brown's lenses could not be written.
  bool lacks_k3() const { return !kalibr_.empty(); }
  /// Before long work. \throws UsageError, DataError as report::check_output_file(); UsageError for one file of two
  void check(bool force) const;
  /// \throws UsageError if a format cannot hold the lenses, after it has written the others; DataError
  void write(const StereoCalibration& calibration) const;

 private:
  std::string kalibr_, opencv_, ros_;
};

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
