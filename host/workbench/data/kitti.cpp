/// \file kitti.cpp  KITTI odometry: sequences/NN/{image_0,image_1 | image_2,image_3}/000000.png, calib.txt, times.txt
/// and poses/NN.txt. Image number k belongs to row k of times.txt and of the poses, so that partial sequences work too.

#include "data/calibrations/forms.hpp"
#include "data/layout.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

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
  std::vector<std::int64_t> stamps;
  for (const Line& line : data_lines(times_file)) {
    parse_row(line, times_file, 1, "a time in seconds");
    stamps.push_back(parse_seconds(split(line.text)[0], times_file, line.number));
  }
  rows = add_numbered_frames(dataset, left, right, stamps, times_file, findings);
}

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
  const fs::path folder =
      sequence_in(fs::is_directory(root / "sequences") ? root / "sequences" : root, is_kitti_recording,
                  options.sequence, "folders that hold image_0 and image_1 (or image_2 and image_3)");
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
    const YamlMap projections(file, "KITTI's calib.txt, with the projection matrices of both cameras");
    const std::string of_left = grey ? "P0" : "P2", of_right = grey ? "P1" : "P3";
    const StatedCalibration cameras = rectified_cameras(projections, of_left, {}, projections, of_right, {});
    left_from_camera0 = projection_offset(projections, of_left);
    dataset.rig.left = cameras.left.lens.camera;
    dataset.rig.right = cameras.right.lens.camera;
    dataset.rig.right_from_left = cameras.right_from_left;
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

}  // namespace

const Layout kKitti{"kitti", is_kitti, read_kitti_odometry, is_kitti_recording};

}  // namespace quadedge::data
