#include "cli/camera_options.hpp"

namespace quadedge::cli {

void declare_cameras(Options& options, DatasetOptions& dataset) {
  options.text("--calibration", dataset.calibration,
               "calibration of both cameras: Kalibr, OpenCV, ROS, EuRoC, or of `check --write-calibration`; instead of "
               "the one that belongs to the layout",
               "FILE[,FILE]");
  options.number(
      "--fov", dataset.fov,
      "horizontal field of view of the pinhole images that a lens's are turned into [degrees]; 0: the lens's "
      "scale in the middle is kept, up to 120");
  options.text("--mask", dataset.mask, "image that is black where no edges are wanted; one, or left and right",
               "FILE[,FILE]");
}

}  // namespace quadedge::cli
