/// \file kitti.cpp  KITTI odometry: sequences/NN/{image_0,image_1 | image_2,image_3}/000000.png, calib.txt, times.txt
/// and poses/NN.txt. Image number k belongs to row k of times.txt and of the poses, so that partial sequences work too.

#include <algorithm>
#include <map>

#include "data/layout.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"

namespace quadedge::data {
namespace {

/// Folder of the sequence: `folder` itself, or the one named by --sequence below the root or below sequences/.
fs::path sequence_folder(const fs::path& folder, const std::string& wanted) {
  if (is_kitti_recording(folder)) {
    if (!wanted.empty() && wanted != folder_name(folder)) {
      fail(folder.string(), "the sequence " + folder_name(folder), "the sequence " + wanted + " asked for");
    }
    return folder;
  }
  const fs::path parent = fs::is_directory(folder / "sequences") ? folder / "sequences" : folder;
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(parent)) {
    if (is_kitti_recording(entry.path())) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  std::string list;
  for (const auto& name : names) list += (list.empty() ? "" : ", ") + name;
  if (names.empty())
    fail(parent.string(), "no sequence", "folders that hold image_0 and image_1 (or image_2 and image_3)");
  if (wanted.empty() && names.size() > 1) {
    throw UsageError(folder.string() + " holds the sequences " + list + ": give the folder of one, such as " +
                     (parent / names[0]).string());
  }
  if (!wanted.empty() && std::find(names.begin(), names.end(), wanted) == names.end()) {
    throw UsageError(folder.string() + " has no sequence " + in_quotes(wanted) + "; there are " + list);
  }
  return parent / (wanted.empty() ? names[0] : wanted);
}

using Projection = Eigen::Matrix<double, 3, 4>;

/// The rows of P0 to P3; others, such as R0_rect, Tr or a date, are not needed.
std::map<std::string, Projection> read_projections(const std::string& file) {
  std::map<std::string, Projection> projections;
  for (const auto& line : data_lines(file)) {
    const std::size_t colon = line.text.find(':');
    const bool is_projection =
        line.text[0] == 'P' && line.text.size() > 2 && line.text[1] >= '0' && line.text[1] <= '3';
    if (!is_projection) continue;
    if (colon == std::string::npos) fail(file, line.number, in_quotes(line.text), "NAME: and twelve numbers");
    const auto values = parse_row({line.number, line.text.substr(colon + 1)}, file, 12, "a 3 x 4 matrix, row by row");
    const auto words = split(line.text.substr(0, colon));
    const auto [entry, is_new] = projections.try_emplace(words.empty() ? "" : words[0], Projection::Zero());
    if (!is_new) fail(file, line.number, "a second row " + entry->first, "each matrix once");
    Projection& projection = entry->second;
    for (int i = 0; i < 12; ++i) projection(i / 4, i % 4) = values[static_cast<std::size_t>(i)];
  }
  return projections;
}

/// K [I | t] of a rectified camera: sets K, returns t = camera_from_camera0 [m].
Eigen::Vector3d set_camera(PinholeCamera& camera, const std::map<std::string, Projection>& projections,
                           const std::string& name, const std::string& file) {
  const auto found = projections.find(name);
  if (found == projections.end()) fail(file, "no row " + name, "the projection matrices of both cameras");
  const Projection& p = found->second;
  if (p(0, 1) != 0 || p(1, 0) != 0 || p(2, 0) != 0 || p(2, 1) != 0 || p(2, 2) != 1 || !(p(0, 0) > 0) ||
      !(p(1, 1) > 0)) {
    fail(file, "a row " + name + " that is not K [I | t]", "fx 0 cx x  0 fy cy y  0 0 1 z of a rectified camera");
  }
  camera.fx = p(0, 0);
  camera.cx = p(0, 2);
  camera.fy = p(1, 1);
  camera.cy = p(1, 2);
  return camera.matrix().inverse() * p.col(3);
}

/// Number in a file name such as 000123.png; -1 if the name is not a number.
long number_of(const std::string& name) {
  const std::string stem = fs::path(name).stem().string();
  if (stem.empty() || stem.size() > 9 || stem.find_first_not_of("0123456789") != std::string::npos) return -1;
  return std::stol(stem);
}

void read_frames(Dataset& dataset, std::vector<std::size_t>& rows, const fs::path& left, const fs::path& right,
                 const std::string& times_file, Findings& findings) {
  const auto names = image_names(left), right_names = image_names(right);
  if (right_names.size() != names.size()) {
    for (const auto& name : names) {
      if (!fs::exists(right / name))
        findings.error((right / name).string(), "no such file", "the right image of " + name);
    }
    findings.error(right.string(), counted(right_names.size(), "image"),
                   std::to_string(names.size()) + " as in " + left.filename().string());
  }
  const auto times = data_lines(times_file);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const long number = number_of(names[i]);
    const std::size_t row = number >= 0 ? static_cast<std::size_t>(number) : i;
    if (row >= times.size()) {
      findings.error(times_file, counted(times.size(), "row"), "a time for the image " + names[i]);
      return;
    }
    const std::size_t before = dataset.frames.size();
    parse_row(times[row], times_file, 1, "a time in seconds");
    add_frame(dataset, parse_seconds(split(times[row].text)[0], times_file, times[row].number), left / names[i],
              right / names[i], findings);
    if (dataset.frames.size() > before) rows.push_back(row);
  }
}

}  // namespace

bool is_kitti_recording(const fs::path& folder) {
  return fs::is_directory(folder / "image_0") || fs::is_directory(folder / "image_2");
}

bool is_kitti(const fs::path& folder) {
  if (is_kitti_recording(folder) || fs::is_directory(folder / "sequences")) return true;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (is_kitti_recording(entry.path()) && fs::exists(entry.path() / "calib.txt")) return true;
  }
  return false;
}

Dataset read_kitti_odometry(const fs::path& root, const DatasetOptions& options, Findings& findings) {
  const fs::path folder = sequence_folder(root, options.sequence);
  Dataset dataset;
  dataset.path = folder.string();
  dataset.name = "kitti_" + folder_name(folder);
  const bool grey = fs::is_directory(folder / "image_0");
  const fs::path left = folder / (grey ? "image_0" : "image_2"), right = folder / (grey ? "image_1" : "image_3");
  std::vector<std::size_t> rows;  // row of each frame in times.txt and in the poses
  findings.attempt([&] { read_frames(dataset, rows, left, right, (folder / "times.txt").string(), findings); });

  Eigen::Vector3d left_from_camera0 = Eigen::Vector3d::Zero();
  findings.attempt([&] {
    const std::string file = (folder / "calib.txt").string();
    const auto projections = read_projections(file);
    left_from_camera0 = set_camera(dataset.rig.left, projections, grey ? "P0" : "P2", file);
    const Eigen::Vector3d right_from_camera0 = set_camera(dataset.rig.right, projections, grey ? "P1" : "P3", file);
    dataset.rig.right_from_left.translation() = right_from_camera0 - left_from_camera0;
    dataset.rig.max_disparity = dataset.rig.left.fx * dataset.rig.baseline() / kNearestRoadDepth;
    set_sizes_from_first_frame(dataset);
  });

  const fs::path clean = whole_path(folder);
  const fs::path truth = clean.parent_path().parent_path() / "poses" / (clean.filename().string() + ".txt");
  if (fs::exists(truth)) {
    dataset.truth_file = truth.string();
    findings.attempt([&] {
      const Trajectory poses = read_kitti(dataset.truth_file);  // of camera 0
      for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i] >= poses.size()) break;
        StampedPose pose = poses[rows[i]];
        pose.stamp_ns = dataset.frames[i].stamp_ns;
        pose.world_from_left = pose.world_from_left * Eigen::Translation3d(-left_from_camera0);
        dataset.truth.push_back(pose);
      }
    });
  }
  return dataset;
}

}  // namespace quadedge::data
