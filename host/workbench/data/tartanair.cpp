/// \file tartanair.cpp  TartanAir: image_left, image_right, pose_left.txt (first version, 640 x 480) or
/// image_lcam_front, image_rcam_front, pose_lcam_front.txt (second version, 640 x 640); poses tx ty tz qx qy qz qw of
/// the camera's body frame, x forward, y right, z down. The cameras are the simulator's; images have no times, 10 Hz is
/// assumed.

#include "data/image_list.hpp"
#include "data/layout.hpp"
#include "data/text.hpp"
#include "data/trajectory_rows.hpp"

namespace quadedge::data {
namespace {

struct Names {
  const char *left, *right, *poses;
};
constexpr Names kVersions[] = {{"image_left", "image_right", "pose_left.txt"},
                               {"image_lcam_front", "image_rcam_front", "pose_lcam_front.txt"}};

const Names* version_of(const fs::path& folder) {
  for (const Names& names : kVersions)
    if (fs::is_directory(folder / names.left) && fs::is_directory(folder / names.right)) return &names;
  return nullptr;
}

Eigen::Isometry3d read_pose(const Line& line, const std::string& file) {
  const auto v = parse_row(line, file, 7, "tx ty tz qx qy qz qw");
  Eigen::Matrix3d body_from_camera;
  body_from_camera << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  return stated_pose({v[0], v[1], v[2]}, {v[6], v[3], v[4], v[5]}, "qx qy qz qw", file, line.number) *
         Eigen::Isometry3d(body_from_camera);
}

bool is_tartanair(const fs::path& folder) { return version_of(folder) != nullptr; }

Dataset read_tartanair(const fs::path& folder, const DatasetOptions&, Findings& findings) {
  Dataset dataset;
  const Names* names = version_of(folder);
  if (names == nullptr) {
    findings.error(folder.string(), "no image_left and image_right", "TartanAir's layout");
    return dataset;
  }
  constexpr std::int64_t kPeriodNs = 100'000'000;
  dataset.notes.push_back("the images have no timestamps; 10 Hz is assumed");
  findings.attempt([&] {
    const auto left = list_images(folder / names->left, false).files,
               right = list_images(folder / names->right, false).files;
    if (left.size() != right.size())
      fail((folder / names->right).string(), counted(right.size(), "image"),
           std::to_string(left.size()) + " as on the left");
    for (std::size_t i = 0; i < left.size(); ++i)
      add_frame(dataset, static_cast<std::int64_t>(i) * kPeriodNs, left[i], right[i], findings);
  });
  constexpr double kDistance = 0.25, kNearestDepth = 0.5;  // m
  set_sizes_from_first_frame(dataset);
  const PinholeCamera size = dataset.rig.left;
  const double focal_length = 0.5 * size.width;  // a field of view of 90 degrees, also of resized images
  set_rectified_rig(dataset.rig, focal_length, 0.5 * size.width, 0.5 * size.height, 0.5 * size.width, kDistance);
  dataset.rig.max_disparity = focal_length * kDistance / kNearestDepth;
  const fs::path truth = folder / names->poses;
  if (fs::exists(truth)) {
    dataset.truth_file = truth.string();
    findings.attempt([&] {
      const auto lines = data_lines(dataset.truth_file);
      for (std::size_t i = 0; i < std::min(lines.size(), dataset.frames.size()); ++i)
        dataset.truth.push_back({dataset.frames[i].stamp_ns, read_pose(lines[i], dataset.truth_file)});
    });
  }
  return dataset;
}

}  // namespace

const Layout kTartanair{"tartanair", is_tartanair, read_tartanair, is_tartanair};

}  // namespace quadedge::data
