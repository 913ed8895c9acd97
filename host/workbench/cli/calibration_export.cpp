/// \file calibration_export.cpp  Kalibr, OpenCV and ROS read what QuadEdge has learned or converted.
#include "cli/calibration_export.hpp"

#include "data/text.hpp"
#include "output/output_folder.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {

void CalibrationExport::declare(Options& options) {
  options.output("--kalibr", kalibr_, "also write it as Kalibr's camera chain, whose lenses have no k3");
  options.output("--opencv", opencv_, "also write it as matrices of OpenCV (M1 D1 M2 D2 R T)");
  options.output("--ros", ros_, "also write it as camera_info of ROS, with R and P that rectify: LEFT,RIGHT");
}

bool CalibrationExport::empty() const { return kalibr_.empty() && opencv_.empty() && ros_.empty(); }

void CalibrationExport::check(bool force) const {
  report::check_output_file(kalibr_, force);
  report::check_output_file(opencv_, force);
  if (ros_.empty()) return;
  const std::vector<std::string> both = data::file_list(ros_);
  if (both.size() != 2) throw UsageError("--ros " + ros_ + ": expected two files: LEFT,RIGHT");
  for (const std::string& file : both) report::check_output_file(file, force);
}

void CalibrationExport::write(const StereoCalibration& calibration) const {
  std::string refused;
  for (const auto& [format, files] : {std::pair{"kalibr", kalibr_}, {"opencv", opencv_}, {"ros", ros_}}) {
    if (files.empty()) continue;
    try {
      write_calibration(files, calibration, format);
    } catch (const UsageError& problem) {
      refused += (refused.empty() ? "" : "; ") + files + ": " + problem.what();
    }
  }
  if (!refused.empty()) throw UsageError(refused);
}

}  // namespace quadedge::cli
