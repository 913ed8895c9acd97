/// \file euroc.cpp  EuRoC MAV: mav0/{cam0,cam1}/{sensor.yaml,data.csv,data/}, and ground truth of the body in
/// mav0/state_groundtruth_estimate0, mocap0 or vicon0. TUM-VI as exported: the same with camchain.yaml beside mav0 or
/// in dso/, or for DSO: cam0/{images/,times.txt} with camchain.yaml. The recorded images are distorted; the rig
/// describes pinhole images with the same K, created by two tables.

#include <algorithm>

#include "data/calibrations/forms.hpp"
#include "data/image_list.hpp"
#include "data/layout.hpp"
#include "data/text.hpp"
#include "data/trajectory_rows.hpp"

namespace quadedge::data {
namespace {

/// Published ground truth has a rate of 200 Hz (or one pose per frame), so that the nearest row is at most 2.5 ms away.
constexpr std::int64_t kTruthToleranceNs = 5'000'000;

/// Times and image files of a camera: of data.csv, or of data/, images/ or itself, with times in a file or the names.
std::vector<std::pair<std::int64_t, std::string>> read_camera(const fs::path& camera) {
  std::vector<std::pair<std::int64_t, std::string>> list;
  if (fs::exists(camera / "data.csv")) {
    list = read_image_list((camera / "data.csv").string());
    for (auto& entry : list) entry.second = (camera / "data" / entry.second).string();
    return list;
  }
  fs::path folder = camera;  // itself, as Kalibr's bagextractor writes it
  for (const char* name : {"data", "images"})
    if (fs::is_directory(camera / name)) folder = camera / name;
  CameraImages images = list_images(folder);
  for (const fs::path& times : {camera / ".." / "timestamps.txt", camera / ".." / ".." / "timestamps.txt"})
    if (images.stamps_ns.empty() && fs::exists(times)) images.stamps_ns = read_times(times.string());
  if (images.stamps_ns.size() != images.files.size())
    fail(camera.string(), counted(images.stamps_ns.size(), "time") + " for " + counted(images.files.size(), "image"),
         "data.csv, times.txt, or names that are times");
  for (std::size_t i = 0; i < images.files.size(); ++i) list.emplace_back(images.stamps_ns[i], images.files[i]);
  return list;
}

void read_frames(Dataset& dataset, const fs::path& folder, Findings& findings) {
  const auto left = read_camera(folder / "cam0"), right = read_camera(folder / "cam1");
  const auto stamps = [](const auto& list) {
    std::vector<std::int64_t> stamps_ns;
    for (const auto& entry : list) stamps_ns.push_back(entry.first);
    return stamps_ns;
  };
  const StampPairs found = pair_stamps(stamps(left), stamps(right));
  for (const auto& [l, r] : found.pairs) add_frame(dataset, left[l].first, left[l].second, right[r].second, findings);
  const std::size_t pairs = found.pairs.size();
  if (2 * pairs < left.size()) {
    findings.error((folder / "cam1" / "data.csv").string(), counted(pairs, "timestamp") + " in common with cam0",
                   "the " + std::to_string(left.size()) + " of the left camera");
  } else if (pairs < left.size() || pairs < right.size()) {  // the published recordings lack a few images
    const std::string note = std::to_string(left.size() - pairs) + " left and " + std::to_string(right.size() - pairs) +
                             " right images without a counterpart are skipped";
    dataset.notes.push_back(note);
    findings.warn(note);
  }
}

/// Body poses of the ground truth, and the left camera's pose at each frame from the nearest row.
void read_truth(Dataset& dataset, const Eigen::Isometry3d& body_from_left) {
  Trajectory rows = read_euroc_poses(dataset.truth_file);
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.stamp_ns < b.stamp_ns; });
  for (const auto& frame : dataset.frames)
    if (const StampedPose* nearest = pose_at(rows, frame.stamp_ns, kTruthToleranceNs))
      dataset.truth.push_back({frame.stamp_ns, nearest->world_from_left * body_from_left});
}

/// Kalibr's chain of a TUM-VI recording; empty if there is none.
std::string camera_chain(const fs::path& folder) {
  for (const fs::path& place : {folder / "camchain.yaml", folder / ".." / "camchain.yaml",
                                folder / ".." / "dso" / "camchain.yaml", folder / "dso" / "camchain.yaml"})
    if (fs::exists(place)) return place.lexically_normal().string();
  return {};
}

/// The left camera in the frame whose poses a file of ground truth has: the body's, or that of a tracked marker, which
/// has a pose of its own in the body.
Eigen::Isometry3d truth_from_left(const fs::path& file, const Eigen::Isometry3d& body_from_left) {
  const fs::path folder = file.parent_path(), sensor = folder / "sensor.yaml";
  if (folder.filename() != "vicon0" || !fs::exists(sensor)) return body_from_left;
  const YamlMap marker(sensor.string(), "the sensor.yaml of a marker");
  return marker.map("T_BS").transform("data").inverse() * body_from_left;
}

/// Reads the first ground truth that the recording has: an estimate or motion capture of the body's pose.
void find_truth(Dataset& dataset, const fs::path& folder, const Eigen::Isometry3d& body_from_left) {
  for (const char* name : {"state_groundtruth_estimate0", "mocap0", "vicon0"}) {
    const fs::path file = folder / name / "data.csv";
    if (!fs::exists(file)) continue;
    dataset.truth_file = file.string();
    return read_truth(dataset, truth_from_left(file, body_from_left));
  }
  if (fs::exists(folder / "leica0" / "data.csv"))
    dataset.notes.push_back(
        "leica0 holds positions without orientation, with which poses are not compared; state_groundtruth_estimate0, "
        "vicon0 or mocap0 would be ground truth");
}

}  // namespace

Trajectory read_euroc_truth(const std::string& file) {
  Trajectory poses = read_euroc_poses(file);
  const fs::path full = fs::absolute(file), sensor = full.parent_path().parent_path() / "cam0/sensor.yaml";
  if (!fs::exists(sensor))
    fail(
        file, "poses of the body and no " + sensor.string(),
        "that file, whose T_BS gives the left camera's poses, the sequence's folder, or a TUM file of the left camera");
  const YamlMap camera(sensor.string(), "the sensor.yaml of a camera");
  const Eigen::Isometry3d from_left = truth_from_left(full, camera.map("T_BS").transform("data"));
  for (StampedPose& pose : poses) pose.world_from_left = pose.world_from_left * from_left;
  return poses;
}

namespace {

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
  // A user's calibration replaces these files; if they exist, they still determine the frame of the ground truth.
  const fs::path left = folder / "cam0" / "sensor.yaml", right = folder / "cam1" / "sensor.yaml";
  const std::string chain = fs::exists(left) ? "" : camera_chain(folder);
  if (!chain.empty()) {
    findings.attempt([&] { set_calibration(dataset, read_calibration(chain)); });
  } else if (options.calibration.empty() || (fs::exists(left) && fs::exists(right))) {
    findings.attempt([&] { set_calibration(dataset, read_euroc_calibration(left.string(), right.string())); });
  }
  Eigen::Isometry3d body_from_left = Eigen::Isometry3d::Identity();
  if (dataset.calibration) body_from_left = dataset.calibration->body_from_left.value_or(body_from_left);
  findings.attempt([&] { find_truth(dataset, folder, body_from_left); });
  return dataset;
}

}  // namespace

const Layout kEuroc{"euroc", is_euroc, read_euroc, is_euroc};

}  // namespace quadedge::data
