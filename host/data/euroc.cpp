/// \file euroc.cpp  EuRoC MAV: mav0/{cam0,cam1}/{sensor.yaml,data.csv,data/},
/// mav0/state_groundtruth_estimate0/data.csv. The recorded images are distorted; the rig describes pinhole images with
/// the same K, created by two tables.

#include <algorithm>
#include <map>
#include <set>

#include "data/calibration_formats.hpp"
#include "data/image_list.hpp"
#include "data/layout.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

/// Published ground truth has a rate of 200 Hz (or one pose per frame), so that the nearest row is at most 2.5 ms away.
constexpr std::int64_t kTruthToleranceNs = 5'000'000;

void read_frames(Dataset& dataset, const fs::path& folder, Findings& findings) {
  const auto left = read_image_list((folder / "cam0" / "data.csv").string());
  const auto right = read_image_list((folder / "cam1" / "data.csv").string());
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
                   counted(left.size() - alone, "timestamp") + " in common with cam0/data.csv",
                   "the " + std::to_string(left.size()) + " of the left camera");
  } else if (alone > 0 || right.size() != left.size()) {  // the published recordings lack a few images
    const std::string note = std::to_string(alone) + " left and " + std::to_string(right.size() + alone - left.size()) +
                             " right images without a counterpart of the same timestamp are skipped";
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

Dataset read_euroc(const fs::path& root, const DatasetOptions& options, Findings& findings) {
  const fs::path folder = fs::is_directory(root / "mav0") ? root / "mav0" : root;
  Dataset dataset;
  dataset.path = folder.string();
  dataset.name = folder_name(root);
  if (dataset.name == "mav0") dataset.name = folder_name(fs::absolute(root / ".."));
  findings.attempt([&] { read_frames(dataset, folder, findings); });
  Eigen::Isometry3d body_from_left = Eigen::Isometry3d::Identity();
  // A user's calibration replaces these files; if they exist, they still determine the frame of the ground truth.
  const fs::path left = folder / "cam0" / "sensor.yaml", right = folder / "cam1" / "sensor.yaml";
  if (options.calibration.empty() || (fs::exists(left) && fs::exists(right))) {
    findings.attempt([&] { set_calibration(dataset, read_euroc_calibration(left.string(), right.string())); });
  }
  if (dataset.calibration) body_from_left = dataset.calibration->body_from_left.value_or(body_from_left);
  const fs::path truth = folder / "state_groundtruth_estimate0" / "data.csv";
  if (fs::exists(truth)) {
    dataset.truth_file = truth.string();
    findings.attempt([&] { read_truth(dataset, body_from_left); });
  }
  return dataset;
}

}  // namespace quadedge::data
