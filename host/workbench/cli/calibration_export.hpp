#pragma once
/// \file calibration_export.hpp  Options that write a calibration for other programs.

#include <string>

#include "cli/command.hpp"
#include "quadedge/calibration.hpp"

namespace quadedge::cli {

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

}  // namespace quadedge::cli
