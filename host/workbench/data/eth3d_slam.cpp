/// \file eth3d_slam.cpp  ETH3D SLAM stereo: rgb/, rgb2/ (same file names), rgb.txt, calibration.txt and
/// calibration2.txt (fx fy cx cy), extrinsics_1_2.txt (3 x 4), groundtruth.txt (TUM, global_from_camera1). Other
/// folders are ignored.
///
/// extrinsics_1_2.txt maps points from camera 2 (rgb2/) to camera 1 (rgb/). In the published recordings its translation
/// is about (-0.09, 0, 0) m: camera 1 is to the RIGHT of camera 2. The sign of that component determines which camera
/// is the left one, so that disparities are positive for either order; the ground truth, which refers to camera 1, is
/// converted to the left camera. `quadedge synth --lens` writes calibration.yaml (see read_calibration) instead of the
/// three files, with camera 1 on the left.
#include <filesystem>

#include "data/layout.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

/// A handheld rig in a room with objects on a table, at 0.5 m or more.
constexpr double kNearestDepth = 0.5;

PinholeCamera read_camera(const std::string& file) {
  const auto lines = data_lines(file);
  if (lines.size() != 1) fail(file, counted(lines.size(), "row"), "one row: fx fy cx cy");
  const auto values = parse_row(lines[0], file, 4, "fx fy cx cy");
  return {values[0], values[1], values[2], values[3], 0, 0};
}

Eigen::Isometry3d read_extrinsics(const std::string& file) {
  const auto lines = data_lines(file);
  if (lines.size() != 3) fail(file, counted(lines.size(), "row"), "three rows of four numbers, camera1_from_camera2");
  std::vector<double> rows;
  for (const Line& line : lines)
    for (const double value : parse_row(line, file, 4, "a row of camera1_from_camera2")) rows.push_back(value);
  return nearest_transform(rows, file);
}

/// Timestamps and file names of the images of camera 1: from rgb.txt, or from the names in rgb/ if there is none.
std::vector<std::pair<std::int64_t, std::string>> read_list(const fs::path& folder) {
  std::vector<std::pair<std::int64_t, std::string>> list;
  const std::string file = (folder / "rgb.txt").string();
  if (fs::exists(file)) {
    for (const auto& line : data_lines(file)) {
      const auto cells = split(line.text);
      if (cells.size() != 2) fail(file, line.number, in_quotes(line.text), "timestamp rgb/NAME.png");
      list.emplace_back(parse_seconds(cells[0], file, line.number), fs::path(cells[1]).filename().string());
    }
    if (list.empty()) fail(file, "no image", "rows of timestamp rgb/NAME.png");
  } else {
    for (const auto& name : image_names(folder / "rgb")) {
      list.emplace_back(parse_seconds(fs::path(name).stem().string(), (folder / "rgb" / name).string(), 1), name);
    }
  }
  return list;
}

void read_frames(Dataset& dataset, const fs::path& folder, bool first_is_left, Findings& findings) {
  const auto list = read_list(folder);
  const std::size_t second = image_names(folder / "rgb2").size();
  for (const auto& [stamp, name] : list) {
    const fs::path one = folder / "rgb" / name, two = folder / "rgb2" / name;
    add_frame(dataset, stamp, first_is_left ? one : two, first_is_left ? two : one, findings);
  }
  if (second != list.size()) {
    findings.error((folder / "rgb2").string(), counted(second, "image"),
                   std::to_string(list.size()) + " as in " + (fs::exists(folder / "rgb.txt") ? "rgb.txt" : "rgb"));
  }
}

/// Reads calibration.txt, calibration2.txt and extrinsics_1_2.txt. \returns camera1_from_camera2
Eigen::Isometry3d read_pinhole_cameras(Dataset& dataset, const fs::path& folder, Findings& findings) {
  Eigen::Isometry3d camera1_from_camera2 = Eigen::Isometry3d::Identity();
  PinholeCamera camera1, camera2;
  findings.attempt([&] { camera1_from_camera2 = read_extrinsics((folder / "extrinsics_1_2.txt").string()); });
  findings.attempt([&] { camera1 = read_camera((folder / "calibration.txt").string()); });
  findings.attempt([&] { camera2 = read_camera((folder / "calibration2.txt").string()); });
  const bool first_is_left = camera1_from_camera2.translation().x() > 0;
  dataset.rig.left = first_is_left ? camera1 : camera2;
  dataset.rig.right = first_is_left ? camera2 : camera1;
  dataset.rig.right_from_left = first_is_left ? camera1_from_camera2.inverse() : camera1_from_camera2;
  dataset.rig.max_disparity = dataset.rig.left.fx * dataset.rig.baseline() / kNearestDepth;
  return camera1_from_camera2;
}

bool is_eth3d_slam(const fs::path& folder) {
  return fs::is_directory(folder / "rgb2") ||
         (fs::is_directory(folder / "rgb") && fs::exists(folder / "calibration.txt"));
}

Dataset read_eth3d_slam(const fs::path& folder, const DatasetOptions& options, Findings& findings) {
  Dataset dataset;
  const fs::path lenses = folder / "calibration.yaml";
  // A user's calibration replaces these files; if they exist, they still determine which camera is the left one.
  const bool has_lenses = fs::exists(lenses);
  const bool has_cameras = !has_lenses && (options.calibration.empty() || fs::exists(folder / "extrinsics_1_2.txt"));
  Eigen::Isometry3d camera1_from_camera2 = Eigen::Isometry3d::Identity();
  if (has_cameras) camera1_from_camera2 = read_pinhole_cameras(dataset, folder, findings);
  const bool first_is_left = !has_cameras || camera1_from_camera2.translation().x() > 0;
  if (!first_is_left) {
    dataset.notes.push_back("the left camera is rgb2/; groundtruth.txt, which refers to rgb/, is converted to it");
  }
  findings.attempt([&] { read_frames(dataset, folder, first_is_left, findings); });
  if (has_lenses) findings.attempt([&] { set_calibration(dataset, read_calibration(lenses.string())); });
  if (has_cameras) findings.attempt([&] { set_sizes_from_first_frame(dataset); });
  if (fs::exists(folder / "groundtruth.txt")) {
    dataset.truth_file = (folder / "groundtruth.txt").string();
    findings.attempt([&] {
      dataset.truth = read_tum(dataset.truth_file);
      if (first_is_left) return;
      for (auto& pose : dataset.truth) pose.world_from_left = pose.world_from_left * camera1_from_camera2;
    });
  }
  return dataset;
}

}  // namespace

const Layout kEth3dSlam{"eth3d-slam", is_eth3d_slam, read_eth3d_slam, is_eth3d_slam};

}  // namespace quadedge::data
