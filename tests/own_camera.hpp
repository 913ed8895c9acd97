#pragma once
/// \file own_camera.hpp  Sources of a user's own camera for tests: images in folders, in a video, in a pipe.

#include "program.hpp"

namespace own_camera {

/// The pairs of the small rendered sequence, read once.
inline const quadedge::Dataset& small_dataset() {
  static const quadedge::Dataset dataset = quadedge::open_dataset(small_sequence());
  return dataset;
}

/// A native calibration file for the small rendered sequence.
inline std::string write_calibration_of_small(const std::string& file) {
  const quadedge::StereoRig& rig = small_dataset().rig;
  quadedge::StereoCalibration calibration;
  calibration.left.camera = rig.left;
  calibration.right.camera = rig.right;
  calibration.right_from_left = rig.right_from_left;
  quadedge::write_calibration(file, calibration);
  return file;
}

/// Both views side by side or one above the other.
inline quadedge::Image joined(const quadedge::Image& left, const quadedge::Image& right, bool beside = true) {
  quadedge::Image both(left.width * (beside ? 2 : 1), left.height * (beside ? 1 : 2), left.max_value);
  for (int y = 0; y < left.height; ++y) {
    for (int x = 0; x < left.width; ++x) {
      both.set(x, y, left.view().value(x, y));
      both.set(x + (beside ? left.width : 0), y + (beside ? 0 : left.height), right.view().value(x, y));
    }
  }
  return both;
}

/// An image as binary PGM.
inline std::string pgm(const quadedge::Image& image) {
  std::string text = "P5\n# a picture\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n" +
                     std::to_string(image.max_value) + "\n";
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int value = image.view().value(x, y);
      if (image.max_value > 255) text += static_cast<char>(value >> 8);
      text += static_cast<char>(value & 255);
    }
  }
  return text;
}

/// The small sequence's pairs, left before right.
inline std::string pgm_stream_of_small() {
  std::string text;
  for (const auto& frame : small_dataset().frames)
    text += pgm(quadedge::read_grey_image(frame.left)) + pgm(quadedge::read_grey_image(frame.right));
  return text;
}

/// Encodes a video from a file of concatenated PGM images with ffmpeg. `options`: of the output.
inline void encode(const std::string& pictures, const std::string& options, const std::string& video) {
  const std::string command =
      "ffmpeg -v error -y -f image2pipe -c:v pgm -framerate 20 -i '" + pictures + "' " + options + " '" + video + "'";
  INFO(command);
  REQUIRE(std::system(command.c_str()) == 0);
}

}  // namespace own_camera
