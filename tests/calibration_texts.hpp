#pragma once
/// \file calibration_texts.hpp  The files of tests/calibrations/, which other programs write of the rig of
/// calibration_files.hpp.

#include "calibration_files.hpp"
#include "data/calibrations/forms.hpp"

namespace calibration_files {

using namespace quadedge;

inline std::string file_of(const std::string& name) { return QUADEDGE_KERNELS "/../tests/calibrations/" + name; }
inline std::string text_of(const std::string& name) { return read_text(file_of(name)); }

/// The text with every occurrence of `from` replaced.
inline std::string changed(std::string text, const std::string& from, const std::string& to) {
  REQUIRE(text.find(from) != std::string::npos);
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

/// camera_info as `ros2 topic echo` prints it; the file is ROS 1's.
inline std::string camera_info_of_ros2(const std::string& side) {
  std::string text = text_of("camera_info_" + side + ".yaml");
  for (const char letter : {'D', 'K', 'R', 'P'})
    text = changed(text, std::string("\n") + letter + ": [",
                   std::string("\n") + static_cast<char>(std::tolower(letter)) + ": [");
  return text;
}

inline void check_rig(const StereoCalibration& read, double tolerance) {
  const Rig rig;
  const auto close = [&](const Lens& lens, const std::string& intrinsics, const std::string& distortion) {
    const auto k = values_of(intrinsics), d = values_of(distortion);
    CHECK(lens.model == LensModel::radial_tangential);
    CHECK(lens.camera.fx == Approx(k[0]).epsilon(1e-12));
    CHECK(lens.camera.fy == Approx(k[1]).epsilon(1e-12));
    CHECK(lens.camera.cx == Approx(k[2]).epsilon(1e-12));
    CHECK(lens.camera.cy == Approx(k[3]).epsilon(1e-12));
    REQUIRE(lens.parameters.size() >= 4);
    for (std::size_t i = 0; i < lens.parameters.size(); ++i)
      CHECK(lens.parameters[i] == Approx(i < 4 ? d[i] : 0).margin(1e-15));
  };
  close(read.left, rig.left_intrinsics, rig.left_distortion);
  close(read.right, rig.right_intrinsics, rig.right_distortion);
  CHECK((read.right_from_left.matrix() - rig.right_from_left().matrix()).cwiseAbs().maxCoeff() < tolerance);
}

}  // namespace calibration_files
