/// \file kalibr.cpp  Kalibr's camera chain, camchain.yaml: cam0, cam1 ... with T_cn_cnm1, the transform of
/// points from the previous camera to this one, or T_cam_imu (from the IMU to the camera), or T_imu_cam, which OpenVINS
/// writes instead. The first two cameras are used, left first.

#include "common/printed.hpp"
#include "data/calibrations/forms.hpp"
#include "data/text.hpp"
#include "data/toml_file.hpp"

namespace quadedge::data {
namespace {

/// Maximum difference between two representations of the same transform, which Kalibr estimates jointly.
constexpr double kTolerance = 1e-3;  // m and rad

std::optional<Eigen::Isometry3d> camera_from_imu(const YamlMap& camera) {
  if (camera.has("T_cam_imu")) return camera.transform("T_cam_imu");
  if (camera.has("T_imu_cam")) return camera.transform("T_imu_cam").inverse();
  return std::nullopt;
}

void check_agreement(const Eigen::Isometry3d& chain, const Eigen::Isometry3d& over_imu, const YamlMap& right) {
  const Eigen::Isometry3d rest = chain.inverse() * over_imu;
  const double metres = rest.translation().norm(), radians = Eigen::AngleAxisd(rest.linear()).angle();
  if (metres <= kTolerance && radians <= kTolerance) return;
  const std::string found =
      printed("a transform that differs from the one via the IMU by %g m and %g rad", metres, radians);
  right.complain("T_cn_cnm1", found, "T_cam_imu of cam1 times the inverse of cam0's: is the order right?");
}

/// The entries of a camera but its pose.
std::string camera_lines(const Lens& lens, Side side) {
  std::vector<double> coefficients = lens.parameters, intrinsics;
  std::string model = "pinhole", distortion = "radtan";
  const auto lead = [&](std::ptrdiff_t count) {  // parameters that stand before the focal lengths
    intrinsics.assign(coefficients.begin(), coefficients.begin() + count);
    coefficients.erase(coefficients.begin(), coefficients.begin() + count);
  };
  switch (lens.model) {
    case LensModel::radial_tangential: break;
    case LensModel::equidistant: distortion = "equidistant"; break;
    case LensModel::field_of_view: distortion = "fov"; break;
    case LensModel::omnidirectional:
      model = "omni";
      lead(1);
      break;
    case LensModel::double_sphere:
    case LensModel::extended_unified:
      model = lens.model == LensModel::double_sphere ? "ds" : "eucm";
      distortion = "none";
      lead(2);
      break;
  }
  if (distortion == "radtan") {
    while (coefficients.size() > 4 && coefficients.back() == 0) coefficients.pop_back();
    if (coefficients.size() > 4) refuse_lens("kalibr", lens, side, "at most k1 k2 p1 p2, as Kalibr's radtan has them");
    coefficients.resize(4);
  }
  const PinholeCamera& camera = lens.camera;
  intrinsics.insert(intrinsics.end(), {camera.fx, camera.fy, camera.cx, camera.cy});
  return "  camera_model: " + model + "\n  distortion_model: " + distortion +
         "\n  distortion_coeffs: " + toml_text(coefficients) + "\n  intrinsics: " + toml_text(intrinsics) +
         "\n  resolution: [" + std::to_string(camera.width) + ", " + std::to_string(camera.height) + "]\n";
}

std::vector<std::string> write_kalibr_chain(const StereoCalibration& calibration) {
  std::string text = "cam0:\n" + camera_lines(calibration.left, Side::left) + "cam1:\n" +
                     camera_lines(calibration.right, Side::right) + "  T_cn_cnm1:\n";
  for (Eigen::Index i = 0; i < 4; ++i)
    text += "  - " + toml_text(row_major(calibration.right_from_left.matrix().row(i))) + "\n";
  return {text};
}

StatedCalibration read_kalibr_chain(const std::vector<CalibrationText>& texts) {
  const YamlMap chain = texts[0].entries().as("a Kalibr chain of two cameras, cam0 and cam1");
  const YamlMap left = chain.map("cam0"), right = chain.map("cam1");
  StatedCalibration calibration;
  calibration.left = read_named_lens(left, "distortion_coeffs");
  calibration.right = read_named_lens(right, "distortion_coeffs");
  const auto left_from_imu = camera_from_imu(left), right_from_imu = camera_from_imu(right);
  if (left_from_imu) calibration.body_from_left = left_from_imu->inverse();
  if (right.has("T_cn_cnm1")) {
    calibration.right_from_left = right.transform("T_cn_cnm1");
    if (left_from_imu && right_from_imu)
      check_agreement(calibration.right_from_left, *right_from_imu * left_from_imu->inverse(), right);
  } else if (left_from_imu && right_from_imu) {
    calibration.right_from_left = *right_from_imu * left_from_imu->inverse();
  } else {
    fail(chain.file(), "neither cam1.T_cn_cnm1 nor T_cam_imu (or T_imu_cam) of both cameras", "one of them");
  }
  return calibration;
}

}  // namespace

const CalibrationForm kKalibrChain{"kalibr",
                                   "a Kalibr camera chain (cam0, cam1)",
                                   false,
                                   [](const CalibrationText& text) { return text.has("cam0"); },
                                   read_kalibr_chain,
                                   write_kalibr_chain};

}  // namespace quadedge::data
