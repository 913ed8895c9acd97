#pragma once
/// \file calibration.hpp  Calibrations of stereo cameras: file contents and the pinhole rig derived from them.

#include <optional>
#include <string>
#include <vector>

#include "quadedge/camera.hpp"

namespace quadedge {

/// Two lenses in a fixed relative pose, as calibrated. Recorded images need not be rectified.
struct StereoCalibration {
  Lens left, right;
  /// Gamma_right = right_from_left * Gamma_left, metres. Rounded to 1e-9 m and 1e-9 rad, well below calibration
  /// accuracy, so that files that store the same rig in different forms give identical bytes.
  Eigen::Isometry3d right_from_left = Eigen::Isometry3d::Identity();
  /// Pose of the left camera in the body (IMU) frame of the ground truth, if the file contains one.
  std::optional<Eigen::Isometry3d> body_from_left;
  std::string format;  ///< the form of the files, as doc/your-own-data.md names it: euroc, kalibr, opencv, ros ...
  std::string files;   ///< files that it was read from, for messages
  std::vector<StereoCalibration> other_sizes;  ///< the same cameras at other image sizes, if the file has several
  /// The cameras of rectified images (camera_info's P), if the files describe them as well: none or one.
  std::vector<StereoCalibration> of_rectified;
};

/// Reads a calibration in one of the forms that doc/your-own-data.md lists; the form is recognised from the content.
/// `files`: one path, or two separated by a comma (left, right). `rectified`: the images are rectified, and
/// StereoCalibration::of_rectified describes them. \throws DataError that names file and entry, the value found and the
/// value expected.
StereoCalibration read_calibration(const std::string& files, bool rectified = false);

/// The formats that write_calibration() knows: kalibr, native (QuadEdge's own), opencv, ros.
std::vector<std::string> calibration_formats();

/// Writes a format of doc/your-own-data.md, with exact numbers. `files`: one path, or two separated by a comma (left,
/// right) for ros, whose R and P rectify the images. \throws UsageError if the format is unknown or cannot hold the
/// lenses, DataError if a file cannot be written.
void write_calibration(const std::string& files, const StereoCalibration& calibration,
                       const std::string& format = "native");

/// Derives the rig of pinhole cameras to which the recorded images are resampled, at the same image size. The rig has
/// undistortion tables for lenses with distortion, and masks for pinhole pixels without a recorded counterpart. `fov`:
/// horizontal field of view of the pinhole images [degrees, below 180]; 0 keeps the scale of each lens at its optical
/// axis, up to 120 degrees. \throws UsageError for a field of view out of range, DataError if the calibration does not
/// contain the image size.
StereoRig make_rig(const StereoCalibration& calibration, double fov = 0);

/// Excludes from edge detection the pixels that are black in an image file of the size of the recorded images, such as
/// a car's bonnet or a vignette. `files`: one file for both cameras, or two separated by a comma (left, right). \throws
/// DataError if a size does not match.
void mask_rig(StereoRig& rig, const std::string& files);

/// The calibration of a rig whose recorded images are pinhole images.
StereoCalibration pinhole_calibration(const StereoRig& rig);

}  // namespace quadedge
