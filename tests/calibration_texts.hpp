#pragma once
/// \file calibration_texts.hpp  The files that other programs write of one rig.

#include <catch2/catch.hpp>
#include <opencv2/calib3d.hpp>

#include "calibration_files.hpp"
#include "data/calibrations/forms.hpp"
#include "geometry/lens_mapping.hpp"

namespace calibration_files {

using namespace quadedge;

constexpr const char* kLeftK = "458.654, 0, 367.215, 0, 457.296, 248.375, 0, 0, 1";
constexpr const char* kRightK = "457.587, 0, 379.999, 0, 456.134, 255.238, 0, 0, 1";

inline std::string matrix4(const Eigen::Isometry3d& transform) {
  std::string text;
  for (int i = 0; i < 3; ++i) text += numbers(row(transform, i)) + ", ";
  return text + "0, 0, 0, 1";
}

inline std::string matrix3(const Eigen::Matrix3d& matrix) {
  std::vector<double> values;
  for (int i = 0; i < 9; ++i) values.push_back(matrix(i / 3, i % 3));
  return numbers(values);
}

inline std::string opencv_matrix(const std::string& name, int rows, int columns, const std::string& data) {
  return name + ": !!opencv-matrix\n   rows: " + std::to_string(rows) + "\n   cols: " + std::to_string(columns) +
         "\n   dt: d\n   data: [ " + data + " ]\n";
}

/// "PREFIXk1: ..." for names and values in the same order.
inline std::string entries(const std::string& prefix, const std::vector<const char*>& names, const std::string& values,
                           const std::string& indent = "") {
  const auto list = values_of(values);
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) text += indent + prefix + names[i] + ": " + numbers({list[i]}) + "\n";
  return text;
}

const std::vector<const char*> kPinhole = {"fx", "fy", "cx", "cy"}, kRadTan = {"k1", "k2", "p1", "p2"};

inline std::string orb_slam3(const Rig& rig) {
  return "%YAML:1.0\nCamera.type: \"PinHole\"\n" + entries("Camera1.", kPinhole, rig.left_intrinsics) +
         entries("Camera1.", kRadTan, rig.left_distortion) + entries("Camera2.", kPinhole, rig.right_intrinsics) +
         entries("Camera2.", kRadTan, rig.right_distortion) + "Camera.width: 752\nCamera.height: 480\n" +
         opencv_matrix("Stereo.T_c1_c2", 4, 4, matrix4(rig.right_from_left().inverse()));
}

inline std::string plain_opencv(const Rig& rig, const std::string& camera, const std::string& distortion) {
  const Eigen::Isometry3d pose = rig.right_from_left();
  const Eigen::Vector3d t = pose.translation();
  return camera + "1: [" + kLeftK + "]\n" + distortion + "1: [" + rig.left_distortion + "]\n" + camera + "2: [" +
         kRightK + "]\n" + distortion + "2: [" + rig.right_distortion + "]\nR: [" + matrix3(pose.linear()) + "]\nT: [" +
         numbers({t.x(), t.y(), t.z()}) + "]\nimage_width: 752\nimage_height: 480\n";
}

/// A rectification as OpenCV computes it: R1, R2, P1, P2.
struct Rectified {
  std::string r1, r2, p1, p2;
  double focal = 0, bf = 0;
  explicit Rectified(const Rig& rig) {
    cv::Mat r, t, first, second, left, right, q;
    rotation_and_translation(rig, r, t);
    cv::stereoRectify(camera_matrix(rig.left_intrinsics), row_matrix(rig.left_distortion),
                      camera_matrix(rig.right_intrinsics), row_matrix(rig.right_distortion), {752, 480}, r, t, first,
                      second, left, right, q);
    const auto text = [](const cv::Mat& m) { return numbers({m.begin<double>(), m.end<double>()}); };
    r1 = text(first);
    r2 = text(second);
    p1 = text(left);
    p2 = text(right);
    focal = right.at<double>(0, 0);
    bf = -right.at<double>(0, 3);
  }
};

inline std::string orb_slam2(const Rig& rig) {
  const Rectified maps(rig);
  std::string text = "%YAML:1.0\nCamera.fx: 435\nCamera.fy: 435\nCamera.cx: 367\nCamera.cy: 252\n";
  for (const bool right : {false, true}) {
    const std::string side = right ? "RIGHT." : "LEFT.";
    text += side + "width: 752\n" + side + "height: 480\n" + opencv_matrix(side + "K", 3, 3, right ? kRightK : kLeftK) +
            opencv_matrix(side + "D", 1, 4, right ? rig.right_distortion : rig.left_distortion) +
            opencv_matrix(side + "R", 3, 3, right ? maps.r2 : maps.r1) +
            opencv_matrix(side + "P", 3, 4, right ? maps.p2 : maps.p1);
  }
  return text;
}

inline std::string stella(const Rig& rig) {
  const Rectified maps(rig);
  return "Camera:\n  setup: \"stereo\"\n  model: \"perspective\"\n  cols: 752\n  rows: 480\n  fx: " +
         numbers({maps.focal}) + "\n  fy: 435\n  cx: 367\n  cy: 252\n  focal_x_baseline: " + numbers({maps.bf}) +
         "\nStereoRectifier:\n  K_left: [" + kLeftK + "]\n  D_left: [" + rig.left_distortion + "]\n  R_left: [" +
         maps.r1 + "]\n  K_right: [" + kRightK + "]\n  D_right: [" + rig.right_distortion + "]\n  R_right: [" +
         maps.r2 + "]\n";
}

inline std::string camera_info_echo(const Rig& rig, bool right, bool lower) {
  const Rectified maps(rig);
  const auto name = [&](char letter) {
    return std::string(1, lower ? static_cast<char>(std::tolower(letter)) : letter);
  };
  return "header:\n  frame_id: cam\nheight: 480\nwidth: 752\ndistortion_model: plumb_bob\n" + name('D') + ": [" +
         (right ? rig.right_distortion : rig.left_distortion) + "]\n" + name('K') + ": [" + (right ? kRightK : kLeftK) +
         "]\n" + name('R') + ": [" + (right ? maps.r2 : maps.r1) + "]\n" + name('P') + ": [" +
         (right ? maps.p2 : maps.p1) + "]\nbinning_x: 0\nbinning_y: 0\nroi:\n  x_offset: 0\n  width: 0\n---\n";
}

inline std::string basalt_pose(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d t = pose.translation();
  std::string text;
  const std::pair<const char*, double> values[] = {{"px", t.x()}, {"py", t.y()}, {"pz", t.z()}, {"qx", q.x()},
                                                   {"qy", q.y()}, {"qz", q.z()}, {"qw", q.w()}};
  for (const auto& [name, value] : values)
    text += std::string(text.empty() ? "{" : ", ") + "\"" + name + "\": " + numbers({value});
  return text + "}";
}

inline std::string basalt(const Rig& rig) {
  const auto camera = [](const std::string& intrinsics, const std::string& distortion) {
    const auto k = values_of(intrinsics), d = values_of(distortion);
    std::string text = "{\"camera_type\": \"pinhole-radtan8\", \"intrinsics\": {";
    for (std::size_t i = 0; i < 4; ++i) text += std::string("\"") + kPinhole[i] + "\": " + numbers({k[i]}) + ", ";
    for (std::size_t i = 0; i < 4; ++i) text += std::string("\"") + kRadTan[i] + "\": " + numbers({d[i]}) + ", ";
    return text + "\"k3\": 0, \"k4\": 0, \"k5\": 0, \"k6\": 0}}";
  };
  return "{\n\t\"value0\": {\n\t\t\"T_imu_cam\": [" + basalt_pose(rig.body_from_left) + ", " +
         basalt_pose(rig.body_from_right) + "],\n\"intrinsics\": [" + camera(rig.left_intrinsics, rig.left_distortion) +
         ", " + camera(rig.right_intrinsics, rig.right_distortion) + "],\n\"resolution\": [[752, 480], [752, 480]]}}\n";
}

/// The left camera refers to a third one, and so does the right one.
inline std::string depthai(const Rig& rig) {
  Eigen::Isometry3d third_from_left = Eigen::Isometry3d::Identity();
  third_from_left.translation() << -0.04, 0.001, 0.002;
  const Eigen::Isometry3d third_from_right = third_from_left * rig.right_from_left().inverse();
  const auto rows = [](const std::string& text) {
    const auto v = values_of(text);
    return "[[" + numbers({v[0], v[1], v[2]}) + "], [" + numbers({v[3], v[4], v[5]}) + "], [" +
           numbers({v[6], v[7], v[8]}) + "]]";
  };
  const auto camera = [&](int socket, const std::string& k, const std::string& d, const Eigen::Isometry3d& to) {
    const Eigen::Vector3d cm = 100 * to.translation();
    return "[" + std::to_string(socket) + ", {\"cameraType\": 0, \"distortionCoeff\": [" + d +
           ", 0, 0, 0, 0, 0, 0, 0, 0, 0, 0], \"extrinsics\": {\"rotationMatrix\": " + rows(matrix3(to.linear())) +
           ", \"toCameraSocket\": 0, \"translation\": {\"x\": " + numbers({cm.x()}) + ", \"y\": " + numbers({cm.y()}) +
           ", \"z\": " + numbers({cm.z()}) + "}}, \"height\": 480, \"width\": 752, \"intrinsicMatrix\": " + rows(k) +
           "}]";
  };
  return "{\"cameraData\": [" + camera(1, kLeftK, rig.left_distortion, third_from_left) + ", " +
         camera(2, kRightK, rig.right_distortion, third_from_right) +
         "], \"stereoRectificationData\": {\"leftCameraSocket\": 1, \"rightCameraSocket\": 2}}";
}

inline std::string realsense(const Rig& rig) {
  const auto camera = [](const std::string& stream, const std::string& intrinsics, const std::string& d) {
    const auto k = values_of(intrinsics);
    std::string coefficients = d;
    std::replace(coefficients.begin(), coefficients.end(), ',', '\t');
    return " Intrinsic of \"" + stream + "\" / 752x480 / {Y8}\n  Width:      \t752\n  Height:     \t480\n  PPX:  \t" +
           numbers({k[2]}) + "\n  PPY:  \t" + numbers({k[3]}) + "\n  Fx:  \t" + numbers({k[0]}) + "\n  Fy:  \t" +
           numbers({k[1]}) + "\n  Distortion: \tBrown Conrady\n  Coeffs: \t" + coefficients +
           "\n  FOV (deg): \t78 x 55\n\n";
  };
  const Eigen::Isometry3d pose = rig.right_from_left();
  std::string turn;
  for (int i = 0; i < 3; ++i)
    turn += "   " + numbers({pose.linear()(i, 0)}) + "  " + numbers({pose.linear()(i, 1)}) + "  " +
            numbers({pose.linear()(i, 2)}) + "\n";
  const Eigen::Vector3d t = pose.translation();
  return "Device info:\n\n" + camera("Infrared 1", rig.left_intrinsics, rig.left_distortion) +
         camera("Infrared 2", rig.right_intrinsics, rig.right_distortion) +
         "Extrinsic from \"Infrared 1\"\t  To\t  \"Infrared 2\" :\n Rotation Matrix:\n" + turn +
         "\n Translation Vector: \t" + numbers({t.x()}) + "  " + numbers({t.y()}) + "  " + numbers({t.z()}) + "\n";
}

inline std::string kitti_cameras(const Rig& rig) {
  const auto spaced = [](std::string text) {
    std::replace(text.begin(), text.end(), ',', ' ');
    return text;
  };
  const Rectified maps(rig);
  const Eigen::Isometry3d pose = rig.right_from_left();
  const Eigen::Vector3d t = pose.translation();
  return "calib_time: 09-Jan-2012 13:57:47\nS_00: 752 480\nK_00: " + spaced(kLeftK) +
         "\nD_00: " + spaced(rig.left_distortion) +
         "\nR_00: 1 0 0 0 1 0 0 0 1\nT_00: 0 0 0\nS_rect_00: 700 400\nP_rect_00: " + spaced(maps.p1) +
         "\nS_01: 752 480\nK_01: " + spaced(kRightK) + "\nD_01: " + spaced(rig.right_distortion) +
         "\nR_01: " + spaced(matrix3(pose.linear())) + "\nT_01: " + spaced(numbers({t.x(), t.y(), t.z()})) +
         "\nS_rect_01: 700 400\nP_rect_01: " + spaced(maps.p2) + "\n";
}

inline std::string matlab(const Rig& rig) {
  const auto camera = [](const char* name, const std::string& intrinsics, const std::string& distortion) {
    const auto k = values_of(intrinsics), d = values_of(distortion);
    return std::string(name) + ":\n  ImageSize: [480 752]\n  IntrinsicMatrix: [" + numbers({k[0]}) + " 0 0; 0 " +
           numbers({k[1]}) + " 0; " + numbers({k[2] + 1}) + " " + numbers({k[3] + 1}) + " 1]\n  RadialDistortion: [" +
           numbers({d[0]}) + " " + numbers({d[1]}) + "]\n  TangentialDistortion: [" + numbers({d[2]}) + " " +
           numbers({d[3]}) + "]\n";
  };
  const Eigen::Isometry3d pose = rig.right_from_left();
  const Eigen::Vector3d mm = 1000 * pose.translation();
  return camera("CameraParameters1", rig.left_intrinsics, rig.left_distortion) +
         camera("CameraParameters2", rig.right_intrinsics, rig.right_distortion) + "RotationOfCamera2: [" +
         matrix3(pose.linear().transpose()) + "]\nTranslationOfCamera2: [" + numbers({mm.x(), mm.y(), mm.z()}) + "]\n";
}

inline void check_rig(const StereoCalibration& read, double tolerance) {
  const Rig rig;
  const auto close = [&](const Lens& lens, const std::string& intrinsics, const std::string& distortion) {
    const auto k = values_of(intrinsics), d = values_of(distortion);
    CHECK(lens.model == LensModel::radial_tangential);
    CHECK(lens.camera.fx == Approx(k[0]).epsilon(1e-12));
    CHECK(lens.camera.fy == Approx(k[1]).epsilon(1e-12));
    CHECK(lens.camera.cx == Approx(k[2]).epsilon(1e-12));
    CHECK(lens.camera.cy == Approx(k[3]).epsilon(1e-12));
    REQUIRE(lens.parameters.size() >= 4);
    for (std::size_t i = 0; i < lens.parameters.size(); ++i)
      CHECK(lens.parameters[i] == Approx(i < 4 ? d[i] : 0).margin(1e-15));
  };
  close(read.left, rig.left_intrinsics, rig.left_distortion);
  close(read.right, rig.right_intrinsics, rig.right_distortion);
  CHECK((read.right_from_left.matrix() - rig.right_from_left().matrix()).cwiseAbs().maxCoeff() < tolerance);
}

}  // namespace calibration_files
