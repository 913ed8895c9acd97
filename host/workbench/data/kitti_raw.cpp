/// \file kitti_raw.cpp  KITTI's raw drives: DATE/DATE_drive_NNNN_sync/{image_00,image_01}/{data/0000000000.png,
/// timestamps.txt}, or image_02 and image_03 in colour; calib_cam_to_cam.txt and the two other calibrations in DATE;
/// oxts/data/0000000000.txt as ground truth. Image number k belongs to row k of timestamps.txt. KITTI-360 has its
/// images in data_rect and data_rgb, its calibration in calibration/perspective.txt above data_2d_raw/DRIVE.

#include <cmath>
#include <cstdio>

#include "data/calibrations/forms.hpp"
#include "data/image_list.hpp"
#include "data/layout.hpp"
#include "data/text.hpp"
#include "quadedge/camera.hpp"

namespace quadedge::data {
namespace {

/// Where a camera's images are: data in KITTI; data_rect in KITTI-360, or data_rgb as recorded.
fs::path images_of(const fs::path& camera) {
  for (const char* name : {"data", "data_rect"})
    if (fs::is_directory(camera / name)) return camera / name;
  return camera / "data_rgb";
}

/// A calibration file in the drive's folder or the one above, where KITTI has it.
std::string calibration_beside(const fs::path& drive, const char* name) {
  for (const fs::path& place : {drive / name, drive / ".." / name, drive / ".." / ".." / "calibration" / name})
    if (fs::exists(place)) return place.lexically_normal().string();
  return (drive / ".." / name).lexically_normal().string();
}

Eigen::Isometry3d read_transform(const std::string& file) {
  return YamlMap(file, "R and T of KITTI's calibrations").transform("R", "T");
}

/// The pose of an OXTS packet in metres, by the Mercator projection of KITTI's development kit.
Eigen::Isometry3d oxts_pose(const std::string& file, double& scale) {
  const auto lines = data_lines(file);
  const auto words = lines.empty() ? std::vector<std::string>() : split(lines[0].text);
  if (words.size() < 6) fail(file, counted(words.size(), "number"), "lat lon alt roll pitch yaw ...");
  double v[6];
  for (std::size_t i = 0; i < 6; ++i) v[i] = parse_number(words[i], file, 1, "lat lon alt roll pitch yaw");
  constexpr double kEarthRadius = 6378137;  // m
  if (scale == 0) scale = std::cos(v[0] * kDegree);
  Eigen::Isometry3d world_from_imu = Eigen::Isometry3d::Identity();
  world_from_imu.translation() << scale * kEarthRadius * v[1] * kDegree,
      scale * kEarthRadius * std::log(std::tan(0.5 * (90 + v[0]) * kDegree)), v[2];
  world_from_imu.linear() =
      (Eigen::AngleAxisd(v[5], Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(v[4], Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(v[3], Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  return world_from_imu;
}

void read_truth(Dataset& dataset, const fs::path& drive, const YamlMap& cameras, const std::string& left,
                const std::vector<std::size_t>& rows) {
  const std::string imu = calibration_beside(drive, "calib_imu_to_velo.txt"),
                    velodyne = calibration_beside(drive, "calib_velo_to_cam.txt");
  if (!fs::exists(imu) || !fs::exists(velodyne)) {
    dataset.notes.push_back("no ground truth: calib_imu_to_velo.txt and calib_velo_to_cam.txt are needed for it");
    return;
  }
  Eigen::Isometry3d rectified_from_camera = Eigen::Isometry3d::Identity();
  if (cameras.has("R_rect_00")) rectified_from_camera.linear() = cameras.rotation("R_rect_00");
  const Eigen::Isometry3d left_from_imu = Eigen::Translation3d(projection_offset(cameras, "P_rect_" + left)) *
                                          rectified_from_camera * read_transform(velodyne) * read_transform(imu);
  double scale = 0;
  dataset.truth_file = (drive / "oxts").string();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    char name[16];
    std::snprintf(name, sizeof name, "%010zu.txt", rows[i]);
    const fs::path packet = drive / "oxts" / "data" / name;
    if (!fs::exists(packet)) continue;
    const Eigen::Isometry3d world_from_imu = oxts_pose(packet.string(), scale);
    dataset.truth.push_back({dataset.frames[i].stamp_ns, world_from_imu * left_from_imu.inverse()});
  }
}

bool is_kitti_raw_drive(const fs::path& folder) {
  return fs::is_directory(images_of(folder / "image_00")) || fs::is_directory(folder / "image_02" / "data");
}

bool is_kitti_raw(const fs::path& folder) {
  if (is_kitti_raw_drive(folder)) return true;
  if (!fs::exists(folder / "calib_cam_to_cam.txt")) return false;
  for (const auto& entry : fs::directory_iterator(folder))
    if (is_kitti_raw_drive(entry.path())) return true;
  return false;
}

Dataset read_kitti_raw(const fs::path& root, const DatasetOptions& options, Findings& findings) {
  const fs::path drive = sequence_in(root, is_kitti_raw_drive, options.sequence,
                                     "drives that hold image_00 and image_01 (or image_02 and image_03)");
  const bool is_grey = fs::is_directory(drive / "image_00");
  const std::string left = is_grey ? "00" : "02", right = is_grey ? "01" : "03";
  Dataset dataset;
  dataset.path = drive.string();
  dataset.name = folder_name(drive);
  std::vector<std::size_t> rows;  // of timestamps.txt, one per frame
  findings.attempt([&] {
    const std::string times_file = (drive / ("image_" + left) / "timestamps.txt").string();
    rows = add_numbered_frames(dataset, images_of(drive / ("image_" + left)), images_of(drive / ("image_" + right)),
                               read_times(times_file), times_file, findings);
  });
  findings.attempt([&] {
    const std::string of_360 = calibration_beside(drive, "perspective.txt"),
                      file = fs::exists(of_360) ? of_360 : calibration_beside(drive, "calib_cam_to_cam.txt");
    const YamlMap cameras(file, "KITTI's calib_cam_to_cam.txt");
    StereoCalibration calibration = judged(read_kitti_cameras(cameras, left, right), "kitti", file);
    if (images_of(drive / ("image_" + left)).filename() == "data_rgb" && !calibration.other_sizes.empty()) {
      StereoCalibration recorded = calibration.other_sizes.front();
      calibration = std::move(recorded);
    }
    if (!dataset.frames.empty()) {
      const FrameFiles& first = dataset.frames.front();
      set_image_sizes(calibration, image_size(first.left), image_size(first.right), first.left);
    }
    set_calibration(dataset, calibration);
    dataset.rig.max_disparity = dataset.rig.left.fx * dataset.rig.baseline() / kNearestRoadDepth;
    if (fs::is_directory(drive / "oxts" / "data") && calibration.left.is_pinhole())
      read_truth(dataset, drive, cameras, left, rows);
  });
  return dataset;
}

}  // namespace

const Layout kKittiRaw{"kitti-raw", is_kitti_raw, read_kitti_raw, is_kitti_raw_drive};

}  // namespace quadedge::data
