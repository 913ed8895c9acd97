/// \file kitti_cameras.cpp  KITTI's calib_cam_to_cam.txt and KITTI-360's perspective.txt: for camera NN the size S, K,
/// D and pose R, T of the camera as it records, and size S_rect, rotation R_rect and projection P_rect of its rectified
/// images. Metres; all cameras refer to camera 00. KITTI's calib.txt has P0 to P3 only.

#include "data/calibrations/forms.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

/// 0 x 0 where the file does not state it.
ImageSize size_of(const YamlMap& cameras, const std::string& key) {
  if (!cameras.has(key)) return {};
  const auto values = cameras.matrix(key, 1, 2);
  for (const double value : values)
    if (!(value >= 1 && value <= kLargestImageSide) || value != std::floor(value))
      cameras.complain(key, "a side of " + format_exact(value), "whole numbers of pixels");
  return {static_cast<int>(values[0]), static_cast<int>(values[1])};
}

StatedLens read_recording(const YamlMap& cameras, const std::string& number) {
  constexpr double kLastOfKitti360 = 0;  // where K has 1
  return read_matrix_lens(cameras, "K_" + number, "D_" + number, size_of(cameras, "S_" + number), kLastOfKitti360);
}

StatedCalibration read_kitti_pair(const std::vector<CalibrationText>& texts) {
  const YamlMap& cameras = texts[0].entries();
  for (const auto& [left, right] : {std::pair("00", "01"), std::pair("02", "03")})
    if (cameras.has("P_rect_" + std::string(left)) && cameras.has("P_rect_" + std::string(right)))
      return read_kitti_cameras(cameras, left, right);
  for (const auto& [left, right] : {std::pair("P0", "P1"), std::pair("P2", "P3")})
    if (cameras.has(left) && cameras.has(right)) return rectified_cameras(cameras, left, {}, cameras, right, {});
  fail(cameras.file(), "one camera of a pair", "P_rect_00 and P_rect_01, or 02 and 03, or P0 and P1, or P2 and P3");
}

}  // namespace

StatedCalibration read_kitti_cameras(const YamlMap& cameras, const std::string& left, const std::string& right) {
  StatedCalibration rectified = rectified_cameras(cameras, "P_rect_" + left, size_of(cameras, "S_rect_" + left),
                                                  cameras, "P_rect_" + right, size_of(cameras, "S_rect_" + right));
  if (cameras.has("K_" + left) && cameras.has("K_" + right) && cameras.has("S_" + left)) {
    StatedCalibration recording;
    recording.left = read_recording(cameras, left);
    recording.right = read_recording(cameras, right);
    recording.right_from_left =
        cameras.transform("R_" + right, "T_" + right) * cameras.transform("R_" + left, "T_" + left).inverse();
    rectified.other_sizes.push_back(std::move(recording));
  }
  return rectified;
}

const CalibrationForm kKittiCameras{
    "kitti", "KITTI's calib_cam_to_cam.txt (P_rect_00) or calib.txt (P0), KITTI-360's perspective.txt", false,
    [](const CalibrationText& text) {
      return text.has("P_rect_00") || text.has("P_rect_02") || (text.has("P0") && text.has("P1")) ||
             (text.has("P2") && text.has("P3"));
    },
    read_kitti_pair};

}  // namespace quadedge::data
