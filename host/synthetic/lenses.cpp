#include "synthetic/lenses.hpp"

#include <algorithm>

#include "common/calibration.hpp"
#include "quadedge/synthetic.hpp"

namespace quadedge {
namespace {

struct NamedLens {
  const char* name;
  LensModel model;
  double focal;  ///< factor for the pinhole camera's focal length
  std::vector<double> parameters;
};

/// The wide-angle lenses have a field of view of 150 to 170 degrees at the default image width.
const std::vector<NamedLens>& lenses() {
  static const std::vector<NamedLens> all = {
      {"pinhole", LensModel::radial_tangential, 1, {}},
      {"radtan", LensModel::radial_tangential, 1, {-0.28, 0.074, 2e-4, 2e-5}},
      {"equidistant", LensModel::equidistant, 0.6, {0.0035, 0.0007, -0.0021, 0.0002}},
      {"fov", LensModel::field_of_view, 0.6, {0.92}},
      {"double-sphere", LensModel::double_sphere, 0.5, {-0.2, 0.58}},
      {"omni", LensModel::omnidirectional, 1.3, {1.2, -0.1, 0.05, 1e-4, -1e-4}},
  };
  return all;
}

}  // namespace

const std::vector<std::string>& synthetic_lenses() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const NamedLens& lens : lenses()) list.emplace_back(lens.name);
    return list;
  }();
  return names;
}

const std::vector<std::string>& synthetic_rigs() {
  static const std::vector<std::string> names = {"rectified", "eth3d-slam"};
  return names;
}

namespace synthetic {

Lens make_lens(const std::string& name, double focal) {
  const auto& all = lenses();
  const auto found = std::find_if(all.begin(), all.end(), [&](const NamedLens& lens) { return name == lens.name; });
  Lens lens;
  lens.model = found->model;
  lens.parameters = found->parameters;
  lens.camera.fx = lens.camera.fy = found->focal * focal;
  return lens;
}

StereoCalibration eth3d_slam_rig() {
  StereoCalibration calibration;
  calibration.left.camera = {726.043884, 726.043884, 385.732483, 262.196411, 742, 464};
  calibration.right.camera = {726.287415, 726.287415, 354.649689, 186.465668, 739, 458};
  Eigen::Matrix3d camera1_from_camera2;
  camera1_from_camera2 << 0.99992036819458, 0.012368063442409, -0.0024963859468699,  //
      -0.012378259561956, 0.99991494417191, -0.0041112052276731,                     //
      0.0024453257210553, 0.0041417786851525, 0.99998843669891;
  calibration.right_from_left.linear() = camera1_from_camera2;
  calibration.right_from_left.translation() << -0.089831538498402, -0.0001915143802762, 0.00019389642693568;
  calibration.right_from_left = rounded_transform(calibration.right_from_left);
  return calibration;
}

}  // namespace synthetic
}  // namespace quadedge
