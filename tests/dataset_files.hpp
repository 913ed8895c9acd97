#pragma once
/// \file dataset_files.hpp  Small made-up recordings for tests, and the path of the real data.

#include <opencv2/imgcodecs.hpp>

#include "testing.hpp"

namespace dataset_files {

using ::write_text;

/// An image with a different value at every position, so that flips and shifts show.
inline cv::Mat pattern(int width, int height, int type = CV_8UC1) {
  cv::Mat image(height, width, type);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width * image.channels(); ++x) {
      if (image.depth() == CV_16U)
        image.ptr<std::uint16_t>(y)[x] = static_cast<std::uint16_t>(257 * ((7 * x + 31 * y) % 256));
      else
        image.ptr<std::uint8_t>(y)[x] = static_cast<std::uint8_t>((7 * x + 31 * y) % 256);
    }
  }
  return image;
}

inline void write_image(const std::string& path, int width = 32, int height = 24, int type = CV_8UC1) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  REQUIRE(cv::imwrite(path, pattern(width, height, type)));
}

/// Truncates a file to a fraction of its length.
inline void truncate(const std::string& path, double part) {
  std::filesystem::resize_file(
      path, static_cast<std::uintmax_t>(part * static_cast<double>(std::filesystem::file_size(path))));
}

/// Path of real data; empty (with a warning in the report) if QUADEDGE_DATA is not set.
inline std::string real_data(const std::string& what) {
  const char* root = std::getenv("QUADEDGE_DATA");
  if (root == nullptr || !std::filesystem::exists(std::filesystem::path(root) / what)) {
    WARN("SKIPPED: no " << what << " below QUADEDGE_DATA");
    return {};
  }
  return (std::filesystem::path(root) / what).string();
}

/// KITTI sequence 07 with `frames` frames below `root`; f 100 px, baseline 0.5 m, 0.1 s and 1 m per frame.
inline std::string write_kitti(const std::string& root, int frames = 4, const std::string& left = "image_0",
                               const std::string& right = "image_1") {
  const std::string folder = root + "/sequences/07";
  std::string times, poses;
  for (int i = 0; i < frames; ++i) {
    const std::string name = "00000" + std::to_string(i) + ".png";
    write_image(folder + "/" + left + "/" + name);
    write_image(folder + "/" + right + "/" + name);
    times += std::to_string(i) + ".000000e-01\n";
    poses += "1 0 0 0 0 1 0 0 0 0 1 " + std::to_string(i) + "\n";
  }
  write_text(folder + "/times.txt", times);
  write_text(root + "/poses/07.txt", poses);
  write_text(
      folder + "/calib.txt",
      "P0: 100 0 15 0 0 100 11 0 0 0 1 0\nP1: 100 0 15 -50 0 100 11 0 0 0 1 0\n"
      "P2: 100 0 15 6 0 100 11 -1 0 0 1 0.01\nP3: 100 0 15 -44 0 100 11 2 0 0 1 0.01\nTr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
  return folder;
}

/// sensor.yaml of a EuRoC camera whose x axis is the body's y axis, `offset` m along it.
inline std::string euroc_sensor(double offset, double k1 = -0.28) {
  return "sensor_type: camera\n# intrinsics: [0]\nT_BS:\n  cols: 4\n  rows: 4\n  data: [0.0, -1.0, 0.0, 0.0,\n"
         "         1.0, 0.0, 0.0, " +
         std::to_string(offset) +
         ",\n         0.0, 0.0, 1.0, 0.0,\n         0.0, 0.0, 0.0, 1.0]\n"
         "rate_hz: 20\nresolution: [32, 24]\ncamera_model: pinhole\nintrinsics: [30.0, 31.0, 15.5, 11.25] #fu, fv, cu, "
         "cv\n"
         "distortion_model: radial-tangential\ndistortion_coefficients: [" +
         std::to_string(k1) + ", 0.07, 0.0, 0.0]\n";
}

/// EuRoC with `frames` frames 50 ms apart, starting at 1403715273312143104 ns; the ground truth is 256 ns off, and the
/// body moves 1 m per frame.
inline std::string write_euroc(const std::string& root, int frames = 4) {
  const std::string folder = root + "/mav0";
  std::string list = "#timestamp [ns],filename\r\n", truth = "#timestamp, p_RS_R_x [m], ...\n";
  for (int i = 0; i < frames; ++i) {
    const std::int64_t stamp = 1403715273312143104 + 50'000'000LL * i;
    const std::string name = std::to_string(stamp) + ".png";
    for (const char* camera : {"cam0", "cam1"}) write_image(folder + "/" + camera + "/data/" + name);
    list += std::to_string(stamp) + "," + name + "\r\n";
    truth += std::to_string(stamp - 256) + "," + std::to_string(i) + ",2,3,1,0,0,0,0,0,0,0,0,0,0,0,0\n";
  }
  write_text(folder + "/cam0/sensor.yaml", euroc_sensor(0.25));
  write_text(folder + "/cam1/sensor.yaml", euroc_sensor(0.36));
  write_text(folder + "/cam0/data.csv", list);
  write_text(folder + "/cam1/data.csv", list);
  write_text(folder + "/state_groundtruth_estimate0/data.csv", truth);
  return root;
}

/// ETH3D SLAM stereo as published: camera 1 (rgb/) is 0.09 m to the right of camera 2 (rgb2/), sizes differ.
inline std::string write_eth3d_slam(const std::string& folder, int frames = 4) {
  std::string list = "# timestamp filename\n", truth;
  for (int i = 0; i < frames; ++i) {
    const std::string stamp = "12." + std::to_string(i) + "25000001";
    write_image(folder + "/rgb/" + stamp + ".png", 32, 24, CV_8UC3);
    write_image(folder + "/rgb2/" + stamp + ".png", 30, 26, CV_8UC3);
    list += stamp + " rgb/" + stamp + ".png\n";
    truth += stamp + " " + std::to_string(i) + " 0 0 0 0 0 1\n";
  }
  write_text(folder + "/rgb.txt", list);
  write_text(folder + "/groundtruth.txt", truth);
  write_text(folder + "/calibration.txt", "40 41 15 11\n");
  write_text(folder + "/calibration2.txt", "42 43 14 12\n");
  write_text(folder + "/extrinsics_1_2.txt", "1 0 0 -0.09\n0 1 0 0\n0 0 1 0.001\n");
  return folder;
}

}  // namespace dataset_files
