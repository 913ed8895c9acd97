#pragma once
/// \file calibration.hpp  Calibrations of stereo cameras: what the files say, and the pinhole rig that follows from it.

#include <optional>
#include <string>

#include "quadedge/lens.hpp"

namespace quadedge {

/// Two lenses fixed to one another, as calibrated. Recorded images need not be rectified.
struct StereoCalibration {
  Lens left, right;
  /// Gamma_right = right_from_left * Gamma_left, metres. Kept to 1e-9 m and 1e-9 rad, far below what any calibration
  /// knows, so that files which write the same rig in different ways give the same bytes.
  Eigen::Isometry3d right_from_left = Eigen::Isometry3d::Identity();
  /// Where the file says how the left camera sits on the body (IMU) that ground truth is told of.
  std::optional<Eigen::Isometry3d> body_from_left;
  std::string format;  ///< euroc | kalibr | opencv | ros | native
  std::string files;   ///< which they were read from, for messages
};

/// Reads a calibration of one of the formats above; which one is told by the content. `files`: a path, or two with a
/// comma between them, left and right. \throws DataError that names file, entry, what was found and what was expected.
StereoCalibration read_calibration(const std::string& files);

/// Writes the native format: ten entries, see doc/your-own-data.md. \throws DataError when the file cannot be written.
void write_calibration(const std::string& file, const StereoCalibration& calibration);

/// The rig of pinhole cameras that the recorded images are turned into, as large as these: undistortion tables where a
/// lens distorts, and masks of what no recorded pixel shows. `fov`: horizontal field of view of the pinhole images
/// [degrees, below 180]; with 0 the scale of each lens at its optical axis is kept, up to 120 degrees. \throws
/// UsageError for a field of view out of range, DataError where the calibration leaves the images' size open.
StereoRig make_rig(const StereoCalibration& calibration, double fov = 0);

/// Hides from the edges what is black in an image file as large as the recorded images: a car's bonnet, a vignette.
/// `files`: one for both cameras, or two with a comma between them, left and right. \throws DataError where it does
/// not fit.
void mask_rig(StereoRig& rig, const std::string& files);

/// The calibration of a rig whose recorded images are pinhole images.
StereoCalibration pinhole_calibration(const StereoRig& rig);

/// Largest disparity of things half a metre before a rig [px], the default where nothing is known of the scene.
double usual_max_disparity(const StereoRig& rig);

}  // namespace quadedge
