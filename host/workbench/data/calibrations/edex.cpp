/// \file edex.cpp  cuVSLAM's EDEX, stereo.edex: a JSON list whose first item has the cameras with their intrinsics, and
/// transform, the pose of the camera in the rig [m], both with x to the right, y up and z backward. The first two
/// cameras are used, left first.

#include <algorithm>

#include "data/calibrations/forms.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

/// cuVSLAM's lens models with the number of their coefficients. Brown's order is k1 k2 k3 p1 p2, the others' is ours.
struct EdexModel {
  const char* name;
  LensModel model;
  std::size_t coefficients;
};
constexpr EdexModel kEdexModels[] = {
    {"pinhole", LensModel::radial_tangential, 0}, {"fisheye", LensModel::equidistant, 4},
    {"fisheye4", LensModel::equidistant, 4},      {"brown5k", LensModel::radial_tangential, 5},
    {"brown", LensModel::radial_tangential, 5},   {"polynomial", LensModel::radial_tangential, 8},
};

StatedLens edex_lens(const YamlMap& camera) {
  const std::string name = camera.word("distortion_model");
  for (const EdexModel& model : kEdexModels) {
    if (name != model.name) continue;
    const auto focal = camera.numbers("focal", 2), principal = camera.numbers("principal", 2);
    StatedLens stated(camera.file(), camera.name("focal"), camera.name("distortion_params"),
                      {focal[0], focal[1], principal[0], principal[1]}, camera.size("size"));
    stated.lens.model = model.model;
    auto& k = stated.lens.parameters;
    if (model.coefficients > 0 || camera.has("distortion_params"))
      k = camera.numbers("distortion_params", model.coefficients);
    if (k.size() == 5) std::rotate(k.begin() + 2, k.begin() + 3, k.end());
    return stated;
  }
  camera.complain("distortion_model", in_quotes(name), "pinhole, fisheye (fisheye4), brown5k (brown) or polynomial");
}

/// The same transform between frames with y down and z forward.
Eigen::Isometry3d with_turned_axes(const Eigen::Isometry3d& transform) {
  const Eigen::DiagonalMatrix<double, 3> turn(1, -1, -1);
  Eigen::Isometry3d turned(Eigen::Matrix3d(turn * transform.linear() * turn));
  turned.translation() = turn * transform.translation();
  return turned;
}

bool is_edex(const CalibrationText& text) {
  const std::size_t first = text.text.find_first_not_of(" \t\r\n");
  return first != std::string::npos && text.text[first] == '[' && text.text.find("\"cameras\"") != std::string::npos;
}

StatedCalibration read_edex(const std::vector<CalibrationText>& texts) {
  const YamlMap& header = texts[0].entries();
  const auto cameras = header.items("cameras");
  if (cameras.size() < 2) header.complain("cameras", counted(cameras.size(), "camera"), "two, left and right");
  const YamlMap &left = cameras[0].second, &right = cameras[1].second;
  StatedCalibration stated;
  stated.left = edex_lens(left.map("intrinsics"));
  stated.right = edex_lens(right.map("intrinsics"));
  const Eigen::Isometry3d pose = right.transform("transform").inverse() * left.transform("transform");
  stated.right_from_left = with_turned_axes(pose);
  if (header.has("cuvslam_version_major") && !stated.right_from_left.isApprox(pose, 1e-6))
    header.complain("cuvslam_version_major", "a dump of cuVSLAM, whose axes depend on its version",
                    "the stereo.edex of a data set: x to the right, y up, z backward");
  return stated;
}

}  // namespace

const CalibrationForm kEdex{"edex", "cuVSLAM's EDEX (cameras: intrinsics, transform)", false, is_edex, read_edex};

}  // namespace quadedge::data
