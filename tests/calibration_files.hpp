#pragma once
/// \file calibration_files.hpp  The same stereo rig in every calibration file format, written for tests.

#include <opencv2/calib3d.hpp>
#include <opencv2/core/persistence.hpp>

#include "dataset_files.hpp"

namespace calibration_files {

/// A rig like EuRoC's: numbers with few digits, so that every format holds them exactly, except for the pose.
struct Rig {
  Eigen::Isometry3d body_from_left, body_from_right;
  std::string left_intrinsics = "458.654, 457.296, 367.215, 248.375",
              right_intrinsics = "457.587, 456.134, 379.999, 255.238";
  std::string left_distortion = "-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05",
              right_distortion = "-0.28368365, 0.07451284, -0.00010473, -3.55590700e-05";
  std::string resolution = "752, 480";

  Rig() {
    body_from_left = Eigen::Translation3d(-0.0216, -0.0647, 0.0098) *
                     Eigen::AngleAxisd(1.55, Eigen::Vector3d(0.02, -0.01, 1).normalized());
    body_from_right = Eigen::Translation3d(-0.0198, 0.0454, 0.0079) *
                      Eigen::AngleAxisd(1.56, Eigen::Vector3d(0.005, 0.003, 1).normalized());
  }
  Eigen::Isometry3d right_from_left() const { return body_from_right.inverse() * body_from_left; }
};

inline std::string numbers(const std::vector<double>& values) {
  std::ostringstream text;
  text.precision(17);
  for (std::size_t i = 0; i < values.size(); ++i) text << (i ? ", " : "") << values[i];
  return text.str();
}

inline std::vector<double> row(const Eigen::Isometry3d& transform, int index) {
  const Eigen::Vector4d values = transform.matrix().row(index).transpose();
  return {values[0], values[1], values[2], values[3]};
}

inline std::string euroc_sensor(const Rig& rig, bool right) {
  const auto& pose = right ? rig.body_from_right : rig.body_from_left;
  std::string data;
  for (int i = 0; i < 4; ++i) data += (i ? ",\n         " : "") + numbers(row(pose, i));
  return "sensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  data: [" + data + "]\nrate_hz: 20\nresolution: [" +
         rig.resolution + "]\ncamera_model: pinhole\nintrinsics: [" +
         (right ? rig.right_intrinsics : rig.left_intrinsics) +
         "]\ndistortion_model: radial-tangential\ndistortion_coefficients: [" +
         (right ? rig.right_distortion : rig.left_distortion) + "]\n";
}

inline std::string kalibr_matrix(const std::string& key, const Eigen::Isometry3d& transform) {
  std::string text = "  " + key + ":\n";
  for (int i = 0; i < 4; ++i) text += "  - [" + numbers(row(transform, i)) + "]\n";
  return text;
}

/// `extrinsics`: T_cn_cnm1, T_cam_imu, T_imu_cam, or "both" for the first two.
inline std::string kalibr_chain(const Rig& rig, const std::string& extrinsics) {
  std::string text;
  for (const bool right : {false, true}) {
    const auto& pose = right ? rig.body_from_right : rig.body_from_left;
    text += right ? "cam1:\n" : "cam0:\n";
    if (extrinsics == "T_imu_cam") text += kalibr_matrix("T_imu_cam", pose);
    if (extrinsics == "T_cam_imu" || extrinsics == "both") text += kalibr_matrix("T_cam_imu", pose.inverse());
    if (right && (extrinsics == "T_cn_cnm1" || extrinsics == "both"))
      text += kalibr_matrix("T_cn_cnm1", rig.right_from_left());
    text += "  cam_overlaps: [" + std::string(right ? "0" : "1") +
            "]\n  camera_model: pinhole\n  distortion_coeffs: [" +
            (right ? rig.right_distortion : rig.left_distortion) + "]\n  distortion_model: radtan\n  intrinsics: [" +
            (right ? rig.right_intrinsics : rig.left_intrinsics) + "]\n  resolution: [" + rig.resolution +
            "]\n  rostopic: /cam" + (right ? "1" : "0") + "/image_raw\n";
  }
  return text;
}

inline std::vector<double> values_of(std::string list) {
  for (char& letter : list) letter = letter == ',' ? ' ' : letter;
  std::istringstream stream(list);
  std::vector<double> values;
  for (double value = 0; stream >> value;) values.push_back(value);
  return values;
}

inline cv::Mat camera_matrix(const std::string& intrinsics) {
  const auto k = values_of(intrinsics);
  return (cv::Mat_<double>(3, 3) << k[0], 0, k[2], 0, k[1], k[3], 0, 0, 1);
}

inline cv::Mat row_matrix(const std::string& list) { return cv::Mat(values_of(list), true).t(); }

inline void rotation_and_translation(const Rig& rig, cv::Mat& r, cv::Mat& t) {
  const Eigen::Isometry3d pose = rig.right_from_left();
  r = cv::Mat(3, 3, CV_64F);
  t = cv::Mat(3, 1, CV_64F);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) r.at<double>(i, j) = pose.linear()(i, j);
    t.at<double>(i) = pose.translation()[i];
  }
}

/// In one file or, with `extrinsics`, in two; the extension selects YAML, XML or JSON.
inline void write_opencv(const Rig& rig, const std::string& intrinsics, const std::string& extrinsics = "") {
  cv::Mat r, t;
  rotation_and_translation(rig, r, t);
  cv::FileStorage first(intrinsics, cv::FileStorage::WRITE);
  first << "M1" << camera_matrix(rig.left_intrinsics) << "D1" << row_matrix(rig.left_distortion) << "M2"
        << camera_matrix(rig.right_intrinsics) << "D2" << row_matrix(rig.right_distortion);
  cv::FileStorage second;
  if (!extrinsics.empty()) second.open(extrinsics, cv::FileStorage::WRITE);
  (extrinsics.empty() ? first : second) << "R" << r << "T" << t;
}

inline std::string ros_matrix(const std::string& key, const cv::Mat& matrix) {
  return key + ":\n  rows: " + std::to_string(matrix.rows) + "\n  cols: " + std::to_string(matrix.cols) +
         "\n  data: [" + numbers({matrix.begin<double>(), matrix.end<double>()}) + "]\n";
}

/// camera_info of both cameras, rectified as by ROS's stereo calibration.
inline std::pair<std::string, std::string> ros_camera_infos(const Rig& rig) {
  cv::Mat r, t, r1, r2, p1, p2, q;
  rotation_and_translation(rig, r, t);
  const cv::Mat m1 = camera_matrix(rig.left_intrinsics), m2 = camera_matrix(rig.right_intrinsics);
  cv::stereoRectify(m1, row_matrix(rig.left_distortion), m2, row_matrix(rig.right_distortion), {752, 480}, r, t, r1, r2,
                    p1, p2, q);
  const auto text = [](const std::string& name, const cv::Mat& m, const std::string& d, const cv::Mat& rectification,
                       const cv::Mat& projection) {
    return "image_width: 752\nimage_height: 480\ncamera_name: " + name + "\n" + ros_matrix("camera_matrix", m) +
           "distortion_model: plumb_bob\n" + ros_matrix("distortion_coefficients", row_matrix(d)) +
           ros_matrix("rectification_matrix", rectification) + ros_matrix("projection_matrix", projection);
  };
  return {text("left", m1, rig.left_distortion, r1, p1), text("right", m2, rig.right_distortion, r2, p2)};
}

}  // namespace calibration_files
