/// \file basalt.cpp  Basalt's calibration, JSON: value0 with lists of T_imu_cam (poses of the cameras in the IMU frame:
/// px py pz [m], qx qy qz qw), intrinsics (camera_type and its parameters) and resolution. The first two cameras are
/// used, left first.

#include "data/calibrations/forms.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

/// Basalt's models, with the names of their parameters in the order of StereoCalibration's.
struct Model {
  const char* name;
  LensModel model;
  std::vector<const char*> parameters;
};

const std::vector<Model>& models() {
  static const std::vector<Model> all = {
      {"pinhole", LensModel::radial_tangential, {}},
      {"pinhole-radtan8", LensModel::radial_tangential, {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"}},
      {"kb4", LensModel::equidistant, {"k1", "k2", "k3", "k4"}},
      {"ds", LensModel::double_sphere, {"xi", "alpha"}},
      {"eucm", LensModel::extended_unified, {"alpha", "beta"}},
      {"ucm", LensModel::extended_unified, {"alpha"}},
      {"fov", LensModel::field_of_view, {"w"}},
  };
  return all;
}

StatedLens read_lens(const YamlMap& camera, ImageSize size) {
  const std::string type = camera.word("camera_type");
  const YamlMap numbers = camera.map("intrinsics");
  for (const Model& model : models()) {
    if (type != model.name) continue;
    StatedLens stated(camera.file(), numbers.name("fx"), camera.name("intrinsics"),
                      numbers.numbers_of({"fx", "fy", "cx", "cy"}), size);
    stated.lens.model = model.model;
    stated.lens.parameters = numbers.numbers_of(model.parameters);
    if (type == "ucm") stated.lens.parameters.push_back(1);  // beta
    return stated;
  }
  camera.complain("camera_type", in_quotes(type), "pinhole, pinhole-radtan8, kb4, ds, eucm, ucm or fov");
}

Eigen::Isometry3d read_pose(const YamlMap& pose) {
  const auto v = pose.numbers_of({"px", "py", "pz", "qw", "qx", "qy", "qz"});
  return Eigen::Translation3d(v[0], v[1], v[2]) * Eigen::Quaterniond(v[3], v[4], v[5], v[6]);
}

StatedCalibration read_basalt(const std::vector<CalibrationText>& texts) {
  const YamlMap& calibration = texts[0].entries();
  const YamlMap value = calibration.has("value0") ? calibration.map("value0") : calibration;
  const auto cameras = value.items("intrinsics"), poses = value.items("T_imu_cam");
  const YamlMatrix sizes = value.matrix("resolution");
  if (cameras.size() < 2 || poses.size() < 2 || sizes.values.size() < 4)
    value.complain("intrinsics", counted(cameras.size(), "camera"), "two, each with T_imu_cam and resolution");
  const auto size = [&](std::size_t camera) {
    return ImageSize{static_cast<int>(sizes.values[2 * camera]), static_cast<int>(sizes.values[2 * camera + 1])};
  };
  StatedCalibration stated;
  stated.left = read_lens(cameras[0].second, size(0));
  stated.right = read_lens(cameras[1].second, size(1));
  stated.body_from_left = read_pose(poses[0].second);
  stated.right_from_left = read_pose(poses[1].second).inverse() * *stated.body_from_left;
  return stated;
}

}  // namespace

const CalibrationForm kBasalt{
    "basalt", "Basalt's calibration (value0: T_imu_cam, intrinsics)", false,
    [](const CalibrationText& text) { return text.has("value0") || (text.has("T_imu_cam") && text.has("intrinsics")); },
    read_basalt};

}  // namespace quadedge::data
