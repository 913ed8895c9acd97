/// \file depthai.cpp  DepthAI's calibration of an OAK camera, JSON: cameraData by socket, lengths in centimetres,
/// extrinsics from one socket to the next; stereoRectificationData names the sockets of the stereo cameras. The
/// sensor's images are scaled and cropped in the middle, as DepthAI itself does for other resolutions.

#include <algorithm>
#include <map>

#include "data/calibrations/forms.hpp"
#include "data/layout.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

constexpr ImageSize kResolutions[] = {{1920, 1200}, {1920, 1080}, {1280, 800}, {1280, 720}, {960, 600}, {640, 480},
                                      {640, 400},   {640, 360},   {480, 300},  {416, 416},  {320, 200}};

StatedLens read_lens(const YamlMap& camera) {
  StatedLens stated = read_matrix_lens(camera, "intrinsicMatrix", "distortionCoeff", camera.size("width", "height"));
  Lens& lens = stated.lens;
  const double type = camera.number_or("cameraType", 0);
  if (type > 1) camera.complain("cameraType", format_exact(type), "0 (perspective) or 1 (fisheye)");
  if (type == 1) {
    lens.model = LensModel::equidistant;
    lens.parameters.resize(std::min<std::size_t>(lens.parameters.size(), 4));
  }
  return stated;
}

using Cameras = std::map<int, YamlMap>;

/// Follows the extrinsics from a socket to the reference that it and others refer to. \returns the sockets passed, each
/// with the transform from `socket`'s frame to its own
std::map<int, Eigen::Isometry3d> reachable(const Cameras& cameras, int socket) {
  std::map<int, Eigen::Isometry3d> transforms = {{socket, Eigen::Isometry3d::Identity()}};
  for (auto camera = cameras.find(socket); camera != cameras.end();) {
    const YamlMap extrinsics = camera->second.map("extrinsics");
    const int next = static_cast<int>(extrinsics.number("toCameraSocket"));
    if (next < 0 || transforms.count(next) > 0) break;
    constexpr double kMetres = 0.01;  // per unit of the file
    const YamlMap translation = extrinsics.map("translation");
    Eigen::Isometry3d step(extrinsics.rotation("rotationMatrix"));
    step.translation() = kMetres * Eigen::Vector3d(translation.numbers_of({"x", "y", "z"}).data());
    transforms[next] = step * transforms.at(camera->first);
    camera = cameras.find(next);
  }
  return transforms;
}

/// The camera for images of another size: scaled until both sides are filled, cropped in the middle.
void resize(PinholeCamera& camera, ImageSize size) {
  const double scale = std::max(1.0 * size.width / camera.width, 1.0 * size.height / camera.height);
  camera.cx = scale * camera.cx - 0.5 * (scale * camera.width - size.width);
  camera.cy = scale * camera.cy - 0.5 * (scale * camera.height - size.height);
  camera.fx *= scale;
  camera.fy *= scale;
  set_size(camera, size);
}

StatedCalibration read_depthai(const std::vector<CalibrationText>& texts) {
  const YamlMap& device = texts[0].entries();
  Cameras cameras;
  for (const auto& [socket, camera] : device.items("cameraData"))
    cameras.emplace(parse_whole(socket, device.file(), device.line("cameraData"), "a camera socket", -1, 100), camera);
  const YamlMap stereo = device.map("stereoRectificationData");
  const int left = static_cast<int>(stereo.number("leftCameraSocket")),
            right = static_cast<int>(stereo.number("rightCameraSocket"));
  if (cameras.count(left) == 0 || cameras.count(right) == 0 || left == right)
    stereo.complain("leftCameraSocket", "sockets " + std::to_string(left) + " and " + std::to_string(right),
                    "two sockets of cameraData");
  StatedCalibration stated;
  stated.left = read_lens(cameras.at(left));
  stated.right = read_lens(cameras.at(right));
  const auto from_left = reachable(cameras, left), from_right = reachable(cameras, right);
  const auto common = std::find_if(from_left.begin(), from_left.end(),
                                   [&](const auto& entry) { return from_right.count(entry.first) > 0; });
  if (common == from_left.end())
    fail(device.file(), "extrinsics that do not join sockets " + std::to_string(left) + " and " + std::to_string(right),
         "toCameraSocket that leads from one to the other");
  stated.right_from_left = from_right.at(common->first).inverse() * common->second;
  for (const ImageSize& size : kResolutions) {
    StatedCalibration other = stated;
    other.other_sizes.clear();
    if (size.width > stated.left.lens.camera.width || size.height > stated.left.lens.camera.height) continue;
    resize(other.left.lens.camera, size);
    resize(other.right.lens.camera, size);
    stated.other_sizes.push_back(std::move(other));
  }
  return stated;
}

}  // namespace

const CalibrationForm kDepthai{"depthai", "DepthAI's calibration of an OAK camera (cameraData)", false,
                               [](const CalibrationText& text) { return text.has("cameraData"); }, read_depthai};

}  // namespace quadedge::data
