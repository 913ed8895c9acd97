#include "calibration_texts.hpp"
#include "quadedge/error.hpp"
#include "temporary_folder.hpp"

using namespace quadedge;
using namespace calibration_files;
using Catch::Matchers::Contains;

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
