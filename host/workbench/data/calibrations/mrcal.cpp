/// \file mrcal.cpp  mrcal's .cameramodel, one file per camera: a Python dictionary of lensmodel, intrinsics (fx fy cx
/// cy, then OpenCV's coefficients), imagersize, and rt_cam_ref (extrinsics before mrcal 2.5): a rotation vector and a
/// translation [m], which map points from a frame that the cameras share to this camera.

#include <algorithm>

#include "data/calibrations/forms.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

StatedLens mrcal_lens(const YamlMap& camera) {
  const std::string name = camera.word("lensmodel");
  for (const std::size_t coefficients : {0U, 4U, 5U, 8U, 12U}) {  // of the models that OpenCV's equations hold
    if (name != (coefficients == 0 ? "LENSMODEL_PINHOLE" : "LENSMODEL_OPENCV" + std::to_string(coefficients))) continue;
    const auto k = camera.numbers("intrinsics", 4 + coefficients);
    StatedLens stated(camera.file(), "intrinsics", "intrinsics", k, camera.size("imagersize"));
    stated.lens.parameters.assign(k.begin() + 4, k.end());
    return stated;
  }
  camera.complain("lensmodel", in_quotes(name),
                  "LENSMODEL_PINHOLE, LENSMODEL_OPENCV4, OPENCV5, OPENCV8 or OPENCV12: `mrcal-convert-lensmodel "
                  "LENSMODEL_OPENCV8 FILE` fits one");
}

Eigen::Isometry3d camera_from_reference(const YamlMap& camera) {
  const bool has_older_name = camera.has("extrinsics");
  const char* key = has_older_name && !camera.has("rt_cam_ref") ? "extrinsics" : "rt_cam_ref";
  const auto rt = camera.numbers(key, 6);
  if (has_older_name && camera.numbers("extrinsics") != rt)
    camera.complain("extrinsics", "other numbers", "those of rt_cam_ref");
  Eigen::Isometry3d pose(rotation_of_vector({rt[0], rt[1], rt[2]}, camera.file() + " (" + key + ")"));
  pose.translation() << rt[3], rt[4], rt[5];
  return pose;
}

bool is_mrcal(const CalibrationText& text) {
  return text.text.find("'lensmodel'") != std::string::npos || text.text.find("\"lensmodel\"") != std::string::npos;
}

StatedCalibration read_mrcal(const std::vector<CalibrationText>& texts) {
  const YamlMap &left = texts[0].entries(), &right = texts[1].entries();
  StatedCalibration stated;
  stated.left = mrcal_lens(left);
  stated.right = mrcal_lens(right);
  stated.right_from_left = camera_from_reference(right) * camera_from_reference(left).inverse();
  return stated;
}

}  // namespace

std::string yaml_of_python(const std::string& python) {
  std::string yaml;
  for (std::size_t at = 0; at < python.size(); ++at) {
    const char letter = python[at];
    if (letter == '\'' || letter == '"') {
      const std::size_t end = std::min(python.find(letter, at + 1), python.size() - 1);
      if (at > 0 && python[at - 1] == 'b') yaml.pop_back();
      yaml.append(python, at, end + 1 - at);
      at = end;
    } else if (letter == '#') {
      at = std::min(python.find('\n', at), python.size()) - 1;
    } else {
      yaml += letter == '(' ? '[' : letter == ')' ? ']' : letter == '\t' ? ' ' : letter;
    }
  }
  return yaml;
}

const CalibrationForm kMrcal{"mrcal", "mrcal's .cameramodel (lensmodel, rt_cam_ref)", true, is_mrcal, read_mrcal};

}  // namespace quadedge::data
