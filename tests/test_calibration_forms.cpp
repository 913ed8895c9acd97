#include <catch2/catch.hpp>
#include <opencv2/calib3d.hpp>

#include "calibration_files.hpp"
#include "data/calibrations/forms.hpp"
#include "geometry/lens_mapping.hpp"
#include "quadedge/error.hpp"
#include "temporary_folder.hpp"

using namespace quadedge;
using namespace calibration_files;
using Catch::Matchers::Contains;

namespace {

constexpr const char* kLeftK = "458.654, 0, 367.215, 0, 457.296, 248.375, 0, 0, 1";
constexpr const char* kRightK = "457.587, 0, 379.999, 0, 456.134, 255.238, 0, 0, 1";

std::string matrix4(const Eigen::Isometry3d& transform) {
  std::string text;
  for (int i = 0; i < 3; ++i) text += numbers(row(transform, i)) + ", ";
  return text + "0, 0, 0, 1";
}

std::string matrix3(const Eigen::Matrix3d& matrix) {
  std::vector<double> values;
  for (int i = 0; i < 9; ++i) values.push_back(matrix(i / 3, i % 3));
  return numbers(values);
}

std::string opencv_matrix(const std::string& name, int rows, int columns, const std::string& data) {
  return name + ": !!opencv-matrix\n   rows: " + std::to_string(rows) + "\n   cols: " + std::to_string(columns) +
         "\n   dt: d\n   data: [ " + data + " ]\n";
}

/// "PREFIXk1: ..." for names and values in the same order.
std::string entries(const std::string& prefix, const std::vector<const char*>& names, const std::string& values,
                    const std::string& indent = "") {
  const auto list = values_of(values);
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) text += indent + prefix + names[i] + ": " + numbers({list[i]}) + "\n";
  return text;
}

const std::vector<const char*> kPinhole = {"fx", "fy", "cx", "cy"}, kRadTan = {"k1", "k2", "p1", "p2"};

std::string orb_slam3(const Rig& rig) {
  return "%YAML:1.0\nCamera.type: \"PinHole\"\n" + entries("Camera1.", kPinhole, rig.left_intrinsics) +
         entries("Camera1.", kRadTan, rig.left_distortion) + entries("Camera2.", kPinhole, rig.right_intrinsics) +
         entries("Camera2.", kRadTan, rig.right_distortion) + "Camera.width: 752\nCamera.height: 480\n" +
         opencv_matrix("Stereo.T_c1_c2", 4, 4, matrix4(rig.right_from_left().inverse()));
}

std::string plain_opencv(const Rig& rig, const std::string& camera, const std::string& distortion) {
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

std::string orb_slam2(const Rig& rig) {
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

std::string stella(const Rig& rig) {
  const Rectified maps(rig);
  return "Camera:\n  setup: \"stereo\"\n  model: \"perspective\"\n  cols: 752\n  rows: 480\n  fx: " +
         numbers({maps.focal}) + "\n  fy: 435\n  cx: 367\n  cy: 252\n  focal_x_baseline: " + numbers({maps.bf}) +
         "\nStereoRectifier:\n  K_left: [" + kLeftK + "]\n  D_left: [" + rig.left_distortion + "]\n  R_left: [" +
         maps.r1 + "]\n  K_right: [" + kRightK + "]\n  D_right: [" + rig.right_distortion + "]\n  R_right: [" +
         maps.r2 + "]\n";
}

std::string camera_info_echo(const Rig& rig, bool right, bool lower) {
  const Rectified maps(rig);
  const auto name = [&](char letter) {
    return std::string(1, lower ? static_cast<char>(std::tolower(letter)) : letter);
  };
  return "header:\n  frame_id: cam\nheight: 480\nwidth: 752\ndistortion_model: plumb_bob\n" + name('D') + ": [" +
         (right ? rig.right_distortion : rig.left_distortion) + "]\n" + name('K') + ": [" + (right ? kRightK : kLeftK) +
         "]\n" + name('R') + ": [" + (right ? maps.r2 : maps.r1) + "]\n" + name('P') + ": [" +
         (right ? maps.p2 : maps.p1) + "]\nbinning_x: 0\nbinning_y: 0\nroi:\n  x_offset: 0\n  width: 0\n---\n";
}

std::string basalt_pose(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d t = pose.translation();
  std::string text;
  const std::pair<const char*, double> values[] = {{"px", t.x()}, {"py", t.y()}, {"pz", t.z()}, {"qx", q.x()},
                                                   {"qy", q.y()}, {"qz", q.z()}, {"qw", q.w()}};
  for (const auto& [name, value] : values)
    text += std::string(text.empty() ? "{" : ", ") + "\"" + name + "\": " + numbers({value});
  return text + "}";
}

std::string basalt(const Rig& rig) {
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
std::string depthai(const Rig& rig) {
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

std::string realsense(const Rig& rig) {
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

std::string kitti_cameras(const Rig& rig) {
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

std::string matlab(const Rig& rig) {
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

void check_rig(const StereoCalibration& read, double tolerance) {
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

}  // namespace

TEST_CASE("calibration forms: the same rig in every program's form", "[calibration]") {
  const TemporaryFolder folder;
  const Rig rig;
  std::map<std::string, std::string> files;
  const auto add = [&](const std::string& name, const std::string& text) {
    write_text(folder / name, text);
    files[name] = folder / name;
  };
  add("orb-slam 3.yaml", orb_slam3(rig));
  add("orb-slam 2.yaml", orb_slam2(rig));
  add("stella-vslam.yaml", stella(rig));
  add("basalt.json", basalt(rig));
  add("depthai.json", depthai(rig));
  add("realsense.txt", realsense(rig));
  add("kitti.txt", kitti_cameras(rig));
  add("matlab.txt", matlab(rig));
  add("opencv K.yaml", plain_opencv(rig, "K", "D"));
  add("opencv cameraMatrix.yaml", plain_opencv(rig, "cameraMatrix", "distCoeffs"));
  for (const bool lower : {false, true}) {
    const std::string name = lower ? "ros 2" : "ros 1";
    write_text(folder / (name + " left"), camera_info_echo(rig, false, lower));
    write_text(folder / (name + " right"), camera_info_echo(rig, true, lower));
    files[name] = (folder / (name + " left")) + "," + (folder / (name + " right"));
  }
  for (const bool right : {false, true}) {
    write_text(folder / (right ? "cam1.yaml" : "cam0.yaml"),
               "%YAML:1.0\n---\nmodel_type: PINHOLE\nimage_width: 752\nimage_height: 480\ndistortion_parameters:\n" +
                   entries("", kRadTan, right ? rig.right_distortion : rig.left_distortion, "   ") +
                   "projection_parameters:\n" +
                   entries("", kPinhole, right ? rig.right_intrinsics : rig.left_intrinsics, "   "));
  }
  add("vins-fusion.yaml", "%YAML:1.0\ncam0_calib: \"cam0.yaml\"\ncam1_calib: \"cam1.yaml\"\n" +
                              opencv_matrix("body_T_cam0", 4, 4, matrix4(rig.body_from_left)) +
                              opencv_matrix("body_T_cam1", 4, 4, matrix4(rig.body_from_right)));
  for (const auto& [name, list] : files) {
    INFO(name);
    StereoCalibration read = read_calibration(list);
    CHECK(name.rfind(read.format, 0) == 0);
    data::set_image_sizes(read, {752, 480}, {752, 480}, "the images");
    check_rig(read, 3e-9);
    write_calibration(folder / "native.yaml", read);
    CHECK(read_calibration(folder / "native.yaml").right_from_left.matrix() == read.right_from_left.matrix());
  }
  // Camera files alone do not say where the cameras are.
  CHECK_THROWS_WITH(read_calibration((folder / "cam0.yaml") + "," + (folder / "cam1.yaml")),
                    Contains("cam0.yaml") && Contains("without the transform") && Contains("body_T_cam0"));
  write_text(folder / "camera.txt", "RadTan 458.654 457.296 367.215 248.375 0 0 0 0\n752 480\ncrop\n640 480\n");
  CHECK_THROWS_WITH(read_calibration(folder / "camera.txt"), Contains("one camera") && Contains("fifth line"));
}

TEST_CASE("calibration forms: rectified images of ORB-SLAM, stella_vslam, KITTI and Stereo DSO", "[calibration]") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& text) {
    write_text(folder / "file.txt", text);
    return read_calibration(folder / "file.txt");
  };
  const std::string camera = "Camera1.fx: 435\nCamera1.fy: 435\nCamera1.cx: 367\nCamera1.cy: 252\n";
  for (const StereoCalibration& rig :
       {read("%YAML:1.0\nCamera.type: \"Rectified\"\n" + camera + "Stereo.b: 0.11\n"),
        read("%YAML:1.0\nCamera.fx: 435\nCamera.fy: 435\nCamera.cx: 367\nCamera.cy: 252\nCamera.bf: 47.85\n"),
        read("Camera.setup: stereo\nCamera.cols: 752\nCamera.rows: 480\nCamera.fx: 435\nCamera.fy: 435\nCamera.cx: "
             "367\nCamera.cy: 252\nCamera.focal_x_baseline: 47.85\n"),
        read("S_rect_00: 752 480\nP_rect_00: 435 0 367 0 0 435 252 0 0 0 1 0\nS_rect_01: 752 480\n"
             "P_rect_01: 435 0 367 -47.85 0 435 252 0 0 0 1 0\n"),
        read("Pinhole 435 435 367 252 0\n752 480\ncrop\n640 480\n0.11\n")}) {
    INFO(rig.format);
    CHECK(rig.left.is_pinhole());
    CHECK(rig.left.camera.cy == 252);
    CHECK(rig.right_from_left.linear().isIdentity());
    CHECK((rig.right_from_left.translation() - Eigen::Vector3d(-0.11, 0, 0)).norm() < 1e-9);
  }
  // KITTI's colour pair, whose left camera is not the reference: both fourth columns count, the third row as well.
  const StereoCalibration colour = read(
      "S_rect_02: 1242 375\nP_rect_02: 721.5 0 609.6 44.86 0 721.5 172.9 0.2164 0 0 1 0.00275\n"
      "S_rect_03: 1242 375\nP_rect_03: 721.5 0 609.6 -339.5 0 721.5 172.9 2.2 0 0 1 0.00273\n");
  const Eigen::Vector3d expected(((-339.5 - 609.6 * 0.00273) - (44.86 - 609.6 * 0.00275)) / 721.5,
                                 ((2.2 - 172.9 * 0.00273) - (0.2164 - 172.9 * 0.00275)) / 721.5, 0.00273 - 0.00275);
  CHECK((colour.right_from_left.translation() - expected).norm() < 1e-9);
  CHECK_THROWS_WITH(read("%YAML:1.0\n" + camera + "Camera1.k1: -0.28\n"),
                    Contains("Stereo.T_c1_c2") && Contains("Camera.bf"));
  CHECK_THROWS_WITH(read("%YAML:1.0\n" + camera + "Stereo.b: 110\n"), Contains("millimetres"));
}

TEST_CASE("calibration forms: a ZED camera's resolutions, and OAK's by scaling and cropping", "[calibration]") {
  const TemporaryFolder folder;
  const auto section = [](const std::string& name, double scale) {
    return "[" + name + "]\nfx=" + numbers({700 * scale}) + "\nfy=" + numbers({701 * scale}) +
           "\ncx=" + numbers({640 * scale}) + "\ncy=" + numbers({360 * scale}) +
           "\nk1=-0.17\nk2=0.02\nk3=0.001\np1=0.0002\np2=0\n\n";
  };
  write_text(folder / "SN1.conf",
             section("LEFT_CAM_HD", 1) + section("RIGHT_CAM_HD", 1) + section("LEFT_CAM_VGA", 0.5) +
                 section("RIGHT_CAM_VGA", 0.5) +
                 "[STEREO]\nBaseline=119.9\nTY=0.1\nTZ=-0.2\nCV_HD=0.01\nRX_HD=-0.002\nRZ_HD=0.003\n"
                 "CV_VGA=0.01\nRX_VGA=-0.002\nRZ_VGA=0.003\n");
  StereoCalibration zed = read_calibration(folder / "SN1.conf");
  CHECK(zed.format == "zed");
  CHECK(zed.left.parameters == std::vector<double>{-0.17, 0.02, 0.0002, 0, 0.001});
  cv::Matx33d turn;
  cv::Rodrigues(cv::Vec3d(-0.002, 0.01, 0.003), turn);
  for (int i = 0; i < 9; ++i)
    CHECK(zed.right_from_left.linear()(i / 3, i % 3) == Approx(turn(i / 3, i % 3)).margin(1e-8));
  CHECK((zed.right_from_left.translation() - Eigen::Vector3d(-0.1199, 0.0001, -0.0002)).norm() < 1e-9);
  data::set_image_sizes(zed, {672, 376}, {672, 376}, "the images");
  CHECK(zed.left.camera.fx == 350);
  StereoCalibration other = read_calibration(folder / "SN1.conf");
  CHECK_THROWS_WITH(data::set_image_sizes(other, {640, 480}, {640, 480}, "a.png"),
                    Contains("1280 x 720 or 672 x 376") && Contains("SN1.conf"));

  // 1280 x 800 of the sensor as 1280 x 720: forty rows less above and below; as 640 x 400: halved.
  std::string oak = depthai(Rig());
  for (std::size_t at = 0; (at = oak.find("\"height\": 480, \"width\": 752", at)) != std::string::npos; ++at)
    oak.replace(at, 27, "\"height\": 800, \"width\": 1280");
  write_text(folder / "oak.json", oak);
  StereoCalibration cropped = read_calibration(folder / "oak.json"), halved = cropped;
  data::set_image_sizes(cropped, {1280, 720}, {1280, 720}, "the images");
  CHECK(cropped.left.camera.fx == 458.654);
  CHECK(cropped.left.camera.cy == Approx(248.375 - 40));
  data::set_image_sizes(halved, {640, 400}, {640, 400}, "the images");
  CHECK(halved.right.camera.fy == Approx(456.134 / 2));
  CHECK(halved.right.camera.cx == Approx(379.999 / 2));
}

TEST_CASE("calibration forms: what no rectified camera states is refused", "[calibration]") {
  const TemporaryFolder folder;
  const auto infos = ros_camera_infos(Rig());
  write_text(folder / "left.yaml", infos.first);
  const std::string both = (folder / "left.yaml") + "," + (folder / "right.yaml");
  const std::size_t p = infos.second.find("projection_matrix"), first_zero = infos.second.find(", 0, ", p);
  std::string skewed = infos.second;
  skewed.replace(first_zero, 5, ", 52.43, ");
  write_text(folder / "right.yaml", skewed);
  CHECK_THROWS_WITH(read_calibration(both), Contains("right.yaml") && Contains("skew"));
  // A fisheye's fifth coefficient is 0 where a program writes five; another value is no fisheye's.
  const auto fisheye = [&](const std::string& text, const std::string& fifth) {
    std::string changed = text;
    changed.replace(changed.find("plumb_bob"), 9, "equidistant");
    const std::size_t at = changed.find("distortion_coefficients"), end = changed.find(']', at);
    changed.replace(changed.find("cols: 4", at), 7, "cols: 5");
    return changed.insert(end, ", " + fifth);
  };
  write_text(folder / "left.yaml", fisheye(infos.first, "0"));
  write_text(folder / "right.yaml", fisheye(infos.second, "0"));
  CHECK(read_calibration(both).left.parameters.size() == 4);
  write_text(folder / "right.yaml", fisheye(infos.second, "0.1"));
  CHECK_THROWS_WITH(read_calibration(both), Contains("right.yaml") && Contains("5 numbers"));
  // Two files of which one is something else: both are described, and all forms are listed.
  write_text(folder / "right.yaml", "gain: 3\n");
  CHECK_THROWS_WITH(read_calibration(both), Contains("right.yaml") && Contains("gain") && Contains("camera_info") &&
                                                Contains("Kalibr") && Contains("DepthAI"));
}

TEST_CASE("calibration forms: region of interest and binning of camera_info", "[calibration]") {
  const TemporaryFolder folder;
  const Rig rig;
  for (const bool right : {false, true}) {
    std::string text = camera_info_echo(rig, right, false);
    text.erase(text.find("binning_x"));
    text += "binning_x: 2\nbinning_y: 2\nroi:\n  x_offset: 8\n  y_offset: 4\n  width: 736\n  height: 472\n";
    write_text(folder / (right ? "right" : "left"), text);
  }
  const Lens lens = read_calibration((folder / "left") + "," + (folder / "right")).left;
  CHECK(lens.camera.fx == Approx(458.654 / 2));
  CHECK(lens.camera.cx == Approx((367.215 - 8) / 2));
  CHECK(lens.camera.cy == Approx((248.375 - 4) / 2));
  CHECK(lens.camera.width == 368);
  CHECK(lens.camera.height == 236);
}

TEST_CASE("calibration forms: the extended unified camera model is the unified one for beta 1", "[calibration]") {
  Lens eucm, unified;
  eucm.camera = {300, 310, 320, 240, 640, 480};
  eucm.model = LensModel::extended_unified;
  eucm.parameters = {0.6, 1};
  // alpha d + (1 - alpha) z = (1 - alpha) (z + xi d) with xi = alpha / (1 - alpha): focal lengths by 1 / (1 - alpha).
  unified.model = LensModel::omnidirectional;
  unified.camera = {300 / 0.4, 310 / 0.4, 320, 240, 640, 480};
  unified.parameters = {0.6 / 0.4};
  for (const Eigen::Vector3d& ray :
       {Eigen::Vector3d(0.1, -0.2, 1), Eigen::Vector3d(1, 0.5, 0.3), Eigen::Vector3d(0, 0, 1)}) {
    const auto one = LensMapping(eucm).project(ray), other = LensMapping(unified).project(ray);
    REQUIRE((one && other));
    CHECK((*one - *other).norm() < 1e-9);
  }
  eucm.parameters = {0.57, 1.2};
  const LensMapping mapping(eucm);
  for (const Eigen::Vector2d& pixel :
       {Eigen::Vector2d(320, 240), Eigen::Vector2d(100, 50), Eigen::Vector2d(600, 400)}) {
    const auto ray = mapping.ray(pixel);
    REQUIRE(ray);
    CHECK((*mapping.project(*ray) - pixel).norm() < 1e-8);
  }
}

TEST_CASE("calibration forms: rectified images have the cameras of the projection matrices", "[calibration]") {
  const TemporaryFolder folder;
  const Rig rig;
  const auto infos = ros_camera_infos(rig);
  write_text(folder / "left.yaml", infos.first);
  write_text(folder / "right.yaml", infos.second);
  write_text(folder / "settings.yaml", orb_slam2(rig));
  cv::Mat r, t, r1, r2, p1, p2, q;  // as OpenCV computes them
  rotation_and_translation(rig, r, t);
  cv::stereoRectify(camera_matrix(rig.left_intrinsics), row_matrix(rig.left_distortion),
                    camera_matrix(rig.right_intrinsics), row_matrix(rig.right_distortion), {752, 480}, r, t, r1, r2, p1,
                    p2, q);
  for (const std::string& files : {(folder / "left.yaml") + "," + (folder / "right.yaml"), folder / "settings.yaml"}) {
    CHECK_FALSE(read_calibration(files).left.is_pinhole());
    const StereoCalibration rectified = read_calibration(files, true);
    CHECK(rectified.left.is_pinhole());
    CHECK(rectified.left.camera.fx == p1.at<double>(0, 0));
    CHECK(rectified.right.camera.cx == p2.at<double>(0, 2));
    CHECK(rectified.right.camera.width == 752);
    CHECK(rectified.right_from_left.linear().isIdentity());
    CHECK(rectified.right_from_left.translation().x() == Approx(p2.at<double>(0, 3) / p2.at<double>(0, 0)));
  }
  write_text(folder / "K.yaml", plain_opencv(rig, "K", "D"));
  CHECK_THROWS_WITH(read_calibration(folder / "K.yaml", true), Contains("K.yaml") && Contains("projection matrices"));
}

TEST_CASE("calibration forms: names of left and right, and models that other programs write", "[calibration]") {
  const TemporaryFolder folder;
  const Rig rig;
  std::string named = plain_opencv(rig, "cameraMatrix", "distCoeffs");
  for (const auto& [from, to] : {std::pair("Matrix1", "MatrixL"), std::pair("Coeffs1", "CoeffsL"),
                                 std::pair("Matrix2", "MatrixR"), std::pair("Coeffs2", "CoeffsR")})
    named.replace(named.find(from), std::string(from).size(), to);
  write_text(folder / "named.yaml", named);
  check_rig(read_calibration(folder / "named.yaml"), 3e-9);
  for (const bool right : {false, true}) {
    const auto k = values_of(right ? rig.right_distortion : rig.left_distortion);
    write_text(folder / (right ? "cam1.yaml" : "cam0.yaml"),
               "%YAML:1.0\n---\nmodel_type: PINHOLE_FULL\nimage_width: 752\nimage_height: 480\ndistortion_parameters:\n"
               "   k1: " +
                   numbers({k[0]}) + "\n   k2: " + numbers({k[1]}) +
                   "\n   k3: 0.01\n   k4: 0.02\n   k5: 0.03\n   k6: 0.04\n   p1: " + numbers({k[2]}) +
                   "\n   p2: " + numbers({k[3]}) + "\nprojection_parameters:\n" +
                   entries("", kPinhole, right ? rig.right_intrinsics : rig.left_intrinsics, "   "));
  }
  write_text(folder / "config.yaml", "%YAML:1.0\ncam0_calib: \"cam0.yaml\"\ncam1_calib: \"cam1.yaml\"\n" +
                                         opencv_matrix("body_T_cam0", 4, 4, matrix4(rig.body_from_left)) +
                                         opencv_matrix("body_T_cam1", 4, 4, matrix4(rig.body_from_right)));
  CHECK(read_calibration(folder / "config.yaml").left.parameters ==
        std::vector<double>{-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05, 0.01, 0.02, 0.03, 0.04});
  std::string unified = basalt(rig);
  for (std::size_t at = 0; (at = unified.find("pinhole-radtan8", at)) != std::string::npos;)
    unified.replace(at, 15, "ucm");
  for (std::size_t at = 0; (at = unified.find("\"k1\": ", at)) != std::string::npos;)
    unified.replace(at, unified.find(',', at) - at, "\"alpha\": 0.6");
  write_text(folder / "ucm.json", unified);
  CHECK(read_calibration(folder / "ucm.json").left.parameters == std::vector<double>{0.6, 1});
}

TEST_CASE("calibration forms: settings of other cameras are not taken for rectified stereo", "[calibration]") {
  const TemporaryFolder folder;
  const auto complaint = [&](const std::string& text) -> std::string {
    write_text(folder / "file.txt", text);
    try {
      read_calibration(folder / "file.txt");
    } catch (const DataError& error) {
      return error.what();
    }
    return "";
  };
  const std::string camera = "Camera.fx: 517\nCamera.fy: 516\nCamera.cx: 318\nCamera.cy: 255\nCamera.bf: 40\n";
  CHECK(complaint("%YAML:1.0\n" + camera + "Camera.k1: 0.0\n").empty());
  CHECK_THAT(complaint("%YAML:1.0\n" + camera + "DepthMapFactor: 5000\n"), Contains("depth camera"));
  CHECK_THAT(complaint("%YAML:1.0\n" + camera + "Camera.k1: 0.26\n"), Contains("Camera.k1") && Contains("rectified"));
  CHECK_THAT(complaint("Camera.setup: stereo\nCamera.cols: 752\nCamera.rows: 480\nCamera.focal_x_baseline: 40\n" +
                       camera + "Camera.k2: 0.1\n"),
             Contains("Camera.k2") && Contains("StereoRectifier"));
  std::string inverse = realsense(Rig());
  inverse.replace(inverse.find("Brown Conrady"), 13, "Inverse Brown Conrady");
  CHECK_THAT(complaint(inverse), Contains("inverse distortion"));
  const std::string skewed = "Camera2.fx: 517\nCamera2.fy: 516\nCamera2.cx: 318\nCamera2.cy: 255\n" +
                             opencv_matrix("Tlr", 3, 4, "1, 0.1, 0, 0.1, 0, 1, 0, 0, 0, 0, 1, 0");
  CHECK_THAT(complaint("%YAML:1.0\n" + camera + skewed), Contains("Tlr") && Contains("orthonormal"));
}

TEST_CASE("calibration forms: OpenCV's YAML has values without a space, as ORB-SLAM2's own settings", "[calibration]") {
  const TemporaryFolder folder;
  std::string text = orb_slam2(Rig());
  for (std::size_t at = 0; (at = text.find("data: [", at)) != std::string::npos; ++at) text.replace(at, 7, "data:[");
  write_text(folder / "settings.yaml",
             text + "Viewer.PointSize:2\nTbc: !!opencv-matrix\n   rows: 1\n   cols: 2\n   data: [1.0 0.0]\n");
  const StereoCalibration read = read_calibration(folder / "settings.yaml");
  CHECK(read.format == "orb-slam");
  check_rig(read, 3e-9);
  write_text(folder / "other.yaml", "Camera.fx:2\nCamera.fy: 2\n");  // without OpenCV's header it is not OpenCV's YAML
  CHECK_THROWS_WITH(read_calibration(folder / "other.yaml"), Contains("other.yaml:2") && Contains("is not YAML"));
}

TEST_CASE("calibration forms: a ZED camera's lens in a section of its own", "[calibration]") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& left, const std::string& right) {
    const std::string camera = "fx = 700\nfy = 701\ncx = 950\ncy = 600\n";
    write_text(folder / "SN2.conf", "; factory\n[LEFT_CAM_FHD1200]\n" + camera + "[RIGHT_CAM_FHD1200]\n" + camera +
                                        "[LEFT_DISTO]\n" + left + "[RIGHT_DISTO]\n" + right +
                                        "[STEREO]\nBaseline = 120\nTY_FHD1200 = 0.3\nTY = 9\nTZ = -0.4\n");
    return read_calibration(folder / "SN2.conf");
  };
  const std::string rational = "k1 = 1\nk2 = 2\np1 = 0.003\np2 = 0.004\nk3 = 5\nk4 = 6\nk5 = 7\nk6 = 8\n",
                    fisheye = "k1 = 0.1\nk2 = 0.2\nk3 = 0.3\nk4 = 0.4\nk5 = 0\nk6 = 0\np1 = 0\np2 = 0\n";
  const StereoCalibration zed = read(rational, fisheye);
  CHECK(zed.left.camera.height == 1200);
  CHECK(zed.left.parameters == std::vector<double>{1, 2, 0.003, 0.004, 5, 6, 7, 8});
  CHECK(zed.right.model == LensModel::equidistant);
  CHECK(zed.right.parameters == std::vector<double>{0.1, 0.2, 0.3, 0.4});
  CHECK((zed.right_from_left.translation() - Eigen::Vector3d(-0.12, 0.0003, -0.0004)).norm() < 1e-9);
  CHECK_THROWS_WITH(read(rational, "\n"), Contains("RIGHT_CAM_FHD1200:K1"));
}

TEST_CASE("calibration forms: MATLAB's numbers as displayed, in any order, in their own unit", "[calibration]") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& text) {
    write_text(folder / "stereo.txt", text);
    return read_calibration(folder / "stereo.txt");
  };
  // A camera after the other for each property; a matrix times 1000; 11 cm to the right, turned by 90 degrees about z.
  const std::string cameras =
      "CameraParameters1.IntrinsicMatrix =\n\n   1.0e+03 *\n\n   0.4500 0 0\n   0 0.4600 0\n   0.3610 0.2410 0.0010\n\n"
      "CameraParameters2.K = [470 0 381; 0 480 251; 0 0 1];\nCameraParameters1.RadialDistortion = [-0.25 0.0625]\n"
      "CameraParameters2.RadialDistortion = [-0.5 0.125 0.5]\nCameraParameters1.TangentialDistortion = [0.001 "
      "-0.002]\n";
  const StereoCalibration centimetres = read(
      cameras + "RotationOfCamera2: [0 1 0; -1 0 0; 0 0 1]\nTranslationOfCamera2: [-11 0 0.5]\nWorldUnits: 'cm'\n");
  CHECK(centimetres.left.camera.fx == 450);
  CHECK(centimetres.left.camera.cx == Approx(360));
  CHECK(centimetres.left.parameters == std::vector<double>{-0.25, 0.0625, 0.001, -0.002, 0});
  CHECK(centimetres.right.camera.cy == 250);
  CHECK(centimetres.right.parameters == std::vector<double>{-0.5, 0.125, 0, 0, 0.5});
  CHECK((centimetres.right_from_left.translation() - Eigen::Vector3d(-0.11, 0, 0.005)).norm() < 1e-9);
  CHECK(centimetres.right_from_left.linear()(1, 0) == Approx(1));  // (0 1 0; -1 0 0; 0 0 1) transposed
  const StereoCalibration posed =
      read("{\"x\":[" + cameras + "],\"PoseCamera2\":{\"R\":[[0,-1,0],[1,0,0],[0,0,1]],\"Translation\":[-110,0,5]}}");
  CHECK(posed.right_from_left.matrix() == centimetres.right_from_left.matrix());
  CHECK_THROWS_WITH(read("CameraParameters1: [1x1 cameraParameters]\nTranslationOfCamera2: [-110 0 0]\n"),
                    Contains("IntrinsicMatrix") && Contains("not a summary") && Contains("jsonencode"));
}

TEST_CASE("calibration forms: KITTI-360's K ends in 0, KITTI's calib.txt has projections only", "[calibration]") {
  const TemporaryFolder folder;
  const Rig rig;
  std::string text = kitti_cameras(rig);
  for (const char* k : {"248.375  0  0  1", "255.238  0  0  1"}) {
    const std::size_t at = text.find(k);
    REQUIRE(at != std::string::npos);
    text[at + 15] = '0';
  }
  write_text(folder / "perspective.txt", text);
  StereoCalibration read = read_calibration(folder / "perspective.txt");
  data::set_image_sizes(read, {752, 480}, {752, 480}, "the images");
  check_rig(read, 3e-9);
  write_text(folder / "calib.txt",
             "P0: 435 0 367 0 0 435 252 0 0 0 1 0\nP1: 435 0 367 -47.85 0 435 252 0 0 0 1 0\n"
             "R0_rect: 1 0 0 0 1 0 0 0 1\n");
  read = read_calibration(folder / "calib.txt");
  CHECK(read.left.camera.cx == 367);
  CHECK(read.right_from_left.translation().x() == Approx(-0.11));
}

TEST_CASE("calibration forms: camera_info of both cameras in one file, and what it leaves out", "[calibration]") {
  const TemporaryFolder folder;
  const Rig rig;
  const std::string left = camera_info_echo(rig, false, true), right = camera_info_echo(rig, true, true);
  write_text(folder / "both.yaml", right + left + right);  // appended in any order, some twice
  check_rig(read_calibration(folder / "both.yaml"), 3e-9);
  write_text(folder / "both.yaml", left + left);
  CHECK_THROWS_WITH(read_calibration(folder / "both.yaml"), Contains("one camera") && Contains("LEFT,RIGHT"));
  const auto with = [&](const std::string& model) {
    for (const bool is_right : {false, true}) {
      std::string text = is_right ? right : left;
      const std::size_t at = text.find("distortion_model");
      text.replace(at, text.find('\n', at) - at, model);
      write_text(folder / (is_right ? "right" : "left"), text);
    }
    return read_calibration((folder / "left") + "," + (folder / "right"));
  };
  check_rig(with("# no model"), 3e-9);
  CHECK_THROWS_WITH(with("distortion_model: none"), Contains("coefficients") && Contains("none"));
  const std::string mono =
      "width: 752\nheight: 480\ndistortion_model: plumb_bob\nD: [0, 0, 0, 0, 0]\nK: [435, 0, 367, 0, "
      "435, 252, 0, 0, 1]\nR: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nP: [435, 0, 367, 0, 0, 435, 252, 0, 0, 0, 1, "
      "0]\n";
  write_text(folder / "left", mono);
  write_text(folder / "right", mono);
  CHECK_THROWS_WITH(read_calibration((folder / "left") + "," + (folder / "right")),
                    Contains("fourth column") && Contains("one by one"));
}

TEST_CASE("calibration forms: words and wrappings that programs leave out or add", "[calibration]") {
  const TemporaryFolder folder;
  const Rig rig;
  const auto read = [&](const std::string& text, bool rectified = false) {
    write_text(folder / "file", text);
    return read_calibration(folder / "file", rectified);
  };
  const auto renamed = [&](std::initializer_list<std::pair<const char*, const char*>> names) {
    std::string text = plain_opencv(rig, "K", "D");
    for (const auto& [from, to] : names) text.replace(text.find(from), std::string(from).size(), to);
    return text;
  };
  check_rig(read(renamed({{"K1:", "Camera_Matrix_Left:"},
                          {"D1:", "Distortion_Left:"},
                          {"K2:", "right_camera_matrix:"},
                          {"D2:", "dist_coeff_R:"},
                          {"\nR:", "\nRot:"},
                          {"\nT:", "\ntranslationVector:"}})),
            3e-9);
  check_rig(read(renamed({{"K1:", "left:\n  K:"}, {"D1:", "  D:"}, {"K2:", "right:\n  K:"}, {"D2:", "  D:"}})), 3e-9);
  const std::string wrapped = basalt(rig);
  check_rig(read(wrapped.substr(wrapped.find('{', 1), wrapped.rfind('}') - wrapped.find('{', 1))), 3e-9);
  std::string wide = "\xFF\xFE";  // as PowerShell redirects
  for (const char letter : realsense(rig)) wide += std::string{letter, '\0'};
  check_rig(read(wide), 3e-9);
  CHECK_THROWS_WITH(read("Stream Profiles supported by Stereo Module\n"), Contains("rs-enumerate-devices -c"));
  const StereoCalibration rectified = read(stella(rig), true);
  CHECK(rectified.left.is_pinhole());
  CHECK(rectified.left.camera.cx == 367);
  CHECK(rectified.right_from_left.linear().isIdentity());
  // DSO's camera.txt without a name: five numbers are the model FOV, or a pinhole with 0.
  CHECK(read("435 435 367 252 0\n752 480\ncrop\n640 480\n0.11\n").left.is_pinhole());
  CHECK(read("435 435 367 252 0.9\n752 480\ncrop\n640 480\n0.11\n").left.model == LensModel::field_of_view);
  CHECK_THROWS_WITH(read("0.53 0.66 0.49 0.5 0.89\n1280 1024\ncrop\n640 480\n"), Contains("one camera"));
  const std::string matrix =
      "camera_matrix: [435, 0, 367, 0, 435, 252, 0, 0, 1]\ndistortion_coefficients: [0, 0, 0, 0]\n";
  CHECK_THROWS_WITH(read(matrix), Contains("without the transform"));
  CHECK_THROWS_WITH(read("hello\n"), Contains("one of these formats") && Contains("Kalibr"));
}
