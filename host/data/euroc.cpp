/// \file euroc.cpp  EuRoC MAV: mav0/{cam0,cam1}/{sensor.yaml,data.csv,data/},
/// mav0/state_groundtruth_estimate0/data.csv. The recorded images are distorted; the rig describes pinhole images of
/// the same K, and two tables make them.

#include <algorithm>
#include <map>
#include <opencv2/calib3d.hpp>
#include <set>
#include <yaml-cpp/yaml.h>

#include "data/layout.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

/// A flying vehicle in a room: 0.5 m before walls and floor, 101 px with the VI-Sensor's f and baseline.
/// Semi-global matching finds 99.9 % of V1_01 below 90 px.
constexpr double kNearestDepth = 0.5;  // m
/// Published ground truth comes at 200 Hz (or once per frame), so the nearest row is at most 2.5 ms away.
constexpr std::int64_t kTruthToleranceNs = 5'000'000;

/// sensor.yaml of one camera.
struct Sensor {
  PinholeCamera camera;
  std::vector<double> distortion;  ///< k1 k2 p1 p2 of OpenCV's model
  Eigen::Isometry3d body_from_camera = Eigen::Isometry3d::Identity();
};

constexpr const char* kSensorFile = "the sensor.yaml of a EuRoC camera";

/// \throws DataError for a key that stands twice in one map: readers of YAML differ in which one counts. Looks no more
/// than `levels` maps deep, which is all that is read; aliases could make it endless.
void check_keys(const YAML::Node& node, const std::string& file, int levels = 2) {
  if (levels == 0 || !node.IsMap()) return;
  std::set<std::string> keys;
  for (const auto& entry : node) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : std::string();
    if (!keys.insert(key).second) fail(file, entry.first.Mark().line + 1, "a second entry " + key, "each entry once");
    check_keys(entry.second, file, levels - 1);
  }
}

/// sensor.yaml, a map. A first line "%YAML:1.0", which OpenCV writes, is no directive of YAML ("%YAML 1.0" would be):
/// it becomes a comment.
YAML::Node read_yaml(const std::string& file) {
  std::string text = read_text(file);
  if (text.rfind("%YAML:", 0) == 0) text[0] = '#';
  try {
    YAML::Node yaml = YAML::Load(text);
    check_keys(yaml, file);
    return yaml;
  } catch (const YAML::Exception& problem) {
    fail(file, problem.mark.line + 1, "text that is no YAML (" + problem.msg + ")", kSensorFile);
  }
}

YAML::Node entry_of(const YAML::Node& map, const std::string& key, const std::string& file) {
  if (!map.IsMap() || !map[key]) fail(file, "no entry " + key, kSensorFile);
  return map[key];
}

/// The numbers of a list, read without yaml-cpp's conversion, which would depend on the locale.
std::vector<double> list_of(const YAML::Node& map, const std::string& key, std::size_t count, const std::string& file) {
  const YAML::Node list = entry_of(map, key, file);
  const std::string expected = key + ": [" + std::to_string(count) + " numbers]";
  const int line = list.Mark().line + 1;
  if (!list.IsSequence()) fail(file, line, "no list for " + key, expected);
  if (list.size() != count) fail(file, line, std::to_string(list.size()) + " numbers for " + key, expected);
  std::vector<double> values;
  for (const YAML::Node& item : list) {
    const std::string token = item.IsScalar() ? item.Scalar() : std::string();
    values.push_back(parse_number(token, file, item.Mark().line + 1, expected));
  }
  return values;
}

std::string word_of(const YAML::Node& map, const std::string& key, const std::string& file) {
  const YAML::Node word = entry_of(map, key, file);
  return word.IsScalar() ? word.Scalar() : std::string();
}

/// "resolution: [columns, rows]"
ImageSize resolution_of(const YAML::Node& map, const std::string& file) {
  const auto sides = list_of(map, "resolution", 2, file);
  for (const double side : sides) {
    if (side < 1 || side > kLargestImageSide || side != std::floor(side)) {
      fail(file, map["resolution"].Mark().line + 1,
           "a resolution of " + format_exact(sides[0]) + " x " + format_exact(sides[1]),
           "whole numbers of pixels from 1 to " + std::to_string(kLargestImageSide));
    }
  }
  return {static_cast<int>(sides[0]), static_cast<int>(sides[1])};
}

Sensor read_sensor(const std::string& file) {
  const YAML::Node yaml = read_yaml(file);
  Sensor sensor;
  const std::string model = word_of(yaml, "camera_model", file);
  if (model != "pinhole") fail(file, "the camera model " + in_quotes(model), "pinhole");
  const std::string lens = word_of(yaml, "distortion_model", file);
  if (lens != "radial-tangential" && lens != "radtan")
    fail(file, "the distortion model " + in_quotes(lens), "radial-tangential");
  const auto intrinsics = list_of(yaml, "intrinsics", 4, file);
  const ImageSize size = resolution_of(yaml, file);
  sensor.camera = {intrinsics[0], intrinsics[1], intrinsics[2], intrinsics[3], size.width, size.height};
  sensor.distortion = list_of(yaml, "distortion_coefficients", 4, file);
  const auto pose = list_of(entry_of(yaml, "T_BS", file), "data", 16, file);
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 16; ++i) matrix(i / 4, i % 4) = pose[static_cast<std::size_t>(i)];
  sensor.body_from_camera.linear() = nearest_rotation(matrix.topLeftCorner<3, 3>(), file + " (T_BS)");
  sensor.body_from_camera.translation() = matrix.topRightCorner<3, 1>();
  return sensor;
}

/// Undistortion to a pinhole image of the same K and size; empty where the lens does not distort.
UndistortionTable table_of(const Sensor& sensor) {
  UndistortionTable table;
  if (std::all_of(sensor.distortion.begin(), sensor.distortion.end(), [](double c) { return c == 0; })) return table;
  const PinholeCamera& camera = sensor.camera;
  const cv::Matx33d k(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  cv::Mat x, y;
  cv::initUndistortRectifyMap(k, sensor.distortion, cv::Matx33d::eye(), k, {camera.width, camera.height}, CV_32FC1, x,
                              y);
  table.width = camera.width;
  table.height = camera.height;
  table.source_x.assign(x.begin<float>(), x.end<float>());
  table.source_y.assign(y.begin<float>(), y.end<float>());
  return table;
}

/// data.csv of a camera: stamp and file name, in the file's order. No stamp comes twice; names lead nowhere else.
std::vector<std::pair<std::int64_t, std::string>> read_list(const fs::path& camera) {
  const std::string file = (camera / "data.csv").string();
  std::vector<std::pair<std::int64_t, std::string>> list;
  std::set<std::int64_t> stamps;
  for (const auto& line : data_lines(file)) {
    const auto cells = split(line.text, ", \t");
    if (cells.size() != 2) fail(file, line.number, in_quotes(line.text), "timestamp [ns],filename");
    list.emplace_back(parse_nanoseconds(cells[0], file, line.number), cells[1]);
    if (!stamps.insert(list.back().first).second)
      fail(file, line.number, "the stamp " + cells[0] + " again", "it once");
    if (fs::path(cells[1]).filename() != cells[1] || cells[1] == "..")
      fail(file, line.number, in_quotes(cells[1]), "the name of an image in data/");
  }
  if (list.empty()) fail(file, "no image", "rows of timestamp [ns],filename");
  return list;
}

void read_frames(Dataset& dataset, const fs::path& folder, Findings& findings) {
  const auto left = read_list(folder / "cam0"), right = read_list(folder / "cam1");
  const std::map<std::int64_t, std::string> right_by_stamp(right.begin(), right.end());
  std::size_t alone = 0;
  for (const auto& [stamp, name] : left) {
    const auto partner = right_by_stamp.find(stamp);
    if (partner == right_by_stamp.end()) {
      ++alone;
      continue;
    }
    add_frame(dataset, stamp, folder / "cam0" / "data" / name, folder / "cam1" / "data" / partner->second, findings);
  }
  if (2 * alone > left.size()) {
    findings.error((folder / "cam1" / "data.csv").string(),
                   std::to_string(left.size() - alone) + " stamps that also stand in cam0/data.csv",
                   "the " + std::to_string(left.size()) + " of the left camera");
  } else if (alone > 0 || right.size() != left.size()) {  // a few dropped images happen in the published recordings
    const std::string note = std::to_string(alone) + " left and " + std::to_string(right.size() + alone - left.size()) +
                             " right images without a partner of the same stamp are left out";
    dataset.notes.push_back(note);
    findings.warn(note);
  }
}

/// Body poses of the ground truth, and the left camera's pose at each frame from the nearest row.
void read_truth(Dataset& dataset, const Eigen::Isometry3d& body_from_left) {
  const std::string& file = dataset.truth_file;
  std::map<std::int64_t, Eigen::Isometry3d> rows;
  constexpr std::size_t kPoseColumns = 8;
  const std::string expected = "timestamp, p_x, p_y, p_z, q_w, q_x, q_y, q_z, ...";
  for (const auto& line : data_lines(file)) {
    const auto cells = split(line.text, ", \t");
    if (cells.size() < kPoseColumns) fail(file, line.number, in_quotes(line.text), expected);
    double v[kPoseColumns];
    for (std::size_t i = 1; i < kPoseColumns; ++i) v[i] = parse_number(cells[i], file, line.number, expected);
    const Eigen::Quaterniond rotation(v[4], v[5], v[6], v[7]);
    constexpr double kTolerance = 1e-3;
    if (std::abs(rotation.norm() - 1) > kTolerance) {
      fail(file, line.number, "a quaternion of length " + std::to_string(rotation.norm()),
           "a unit quaternion q_w q_x q_y q_z");
    }
    Eigen::Isometry3d world_from_body = Eigen::Isometry3d::Identity();
    world_from_body.linear() = rotation.normalized().toRotationMatrix();
    world_from_body.translation() << v[1], v[2], v[3];
    rows[parse_nanoseconds(cells[0], file, line.number)] = world_from_body;
  }
  for (const auto& frame : dataset.frames) {
    auto nearest = rows.lower_bound(frame.stamp_ns);
    if (nearest == rows.end() ||
        (nearest != rows.begin() && frame.stamp_ns - std::prev(nearest)->first < nearest->first - frame.stamp_ns)) {
      if (nearest == rows.begin()) return;
      --nearest;
    }
    if (std::abs(nearest->first - frame.stamp_ns) > kTruthToleranceNs) continue;
    dataset.truth.push_back({frame.stamp_ns, nearest->second * body_from_left});
  }
}

}  // namespace

bool is_euroc(const fs::path& folder) {
  return fs::is_directory(folder / "mav0") || fs::is_directory(folder / "cam0") || fs::is_directory(folder / "cam1");
}

Dataset read_euroc(const fs::path& root, const DatasetOptions&, Findings& findings) {
  const fs::path folder = fs::is_directory(root / "mav0") ? root / "mav0" : root;
  Dataset dataset;
  dataset.path = folder.string();
  dataset.name = folder_name(root);
  if (dataset.name == "mav0") dataset.name = folder_name(fs::absolute(root / ".."));
  findings.attempt([&] { read_frames(dataset, folder, findings); });
  Eigen::Isometry3d body_from_left = Eigen::Isometry3d::Identity();
  findings.attempt([&] {
    const Sensor left = read_sensor((folder / "cam0" / "sensor.yaml").string());
    const Sensor right = read_sensor((folder / "cam1" / "sensor.yaml").string());
    body_from_left = left.body_from_camera;
    dataset.rig.left = left.camera;
    dataset.rig.right = right.camera;
    dataset.rig.right_from_left = right.body_from_camera.inverse() * left.body_from_camera;
    dataset.max_disparity = dataset.rig.left.fx * dataset.rig.baseline() / kNearestDepth;
    // Tables of a resolution that is no image's may fill the memory; what is wrong is said where the images are read.
    if (!sizes_fit(dataset)) return;
    dataset.rig.left_undistortion = table_of(left);
    dataset.rig.right_undistortion = table_of(right);
  });
  const fs::path truth = folder / "state_groundtruth_estimate0" / "data.csv";
  if (fs::exists(truth)) {
    dataset.truth_file = truth.string();
    findings.attempt([&] { read_truth(dataset, body_from_left); });
  }
  return dataset;
}

}  // namespace quadedge::data
