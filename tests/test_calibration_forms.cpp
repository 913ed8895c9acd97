#include "calibration_texts.hpp"

using namespace quadedge;
using namespace calibration_files;
using Catch::Matchers::Contains;

TEST_CASE("calibration forms: the same rig in every program's form") {
  const TemporaryFolder folder;
  std::map<std::string, std::string> files = {
      {"ros 1", file_of("camera_info_left.yaml") + "," + file_of("camera_info_right.yaml")},
      {"ros 2", (folder / "left") + "," + (folder / "right")},
      {"opencv cameraMatrix", folder / "opencv.yaml"}};
  for (const char* side : {"left", "right"}) write_text(folder / side, camera_info_of_ros2(side));
  write_text(folder / "opencv.yaml", changed(changed(text_of("opencv.yaml"), "K", "cameraMatrix"), "D", "distCoeffs"));
  for (const char* name : {"orb-slam3.yaml", "orb-slam2.yaml", "stella-vslam.yaml", "basalt.json", "depthai.json",
                           "realsense.output", "kitti.calib", "matlab.output", "opencv.yaml", "vins-fusion.yaml"})
    files[name] = file_of(name);
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
  CHECK_THROWS_WITH(read_calibration(file_of("vins_cam0.yaml") + "," + file_of("vins_cam1.yaml")),
                    Contains("cam0.yaml") && Contains("without the transform") && Contains("body_T_cam0"));
  write_text(folder / "camera.txt", "RadTan 458.654 457.296 367.215 248.375 0 0 0 0\n752 480\ncrop\n640 480\n");
  CHECK_THROWS_WITH(read_calibration(folder / "camera.txt"), Contains("one camera") && Contains("fifth line"));
}

TEST_CASE("calibration forms: rectified images of ORB-SLAM, stella_vslam, KITTI and Stereo DSO") {
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

TEST_CASE("calibration forms: what no rectified camera states is refused") {
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

TEST_CASE("calibration forms: rectified images have the cameras of the projection matrices") {
  const TemporaryFolder folder;
  const Rig rig;
  const auto infos = ros_camera_infos(rig);
  write_text(folder / "left.yaml", infos.first);
  write_text(folder / "right.yaml", infos.second);
  cv::Mat r, t, r1, r2, p1, p2, q;  // as OpenCV computes them
  rotation_and_translation(rig, r, t);
  cv::stereoRectify(camera_matrix(rig.left_intrinsics), row_matrix(rig.left_distortion),
                    camera_matrix(rig.right_intrinsics), row_matrix(rig.right_distortion), {752, 480}, r, t, r1, r2, p1,
                    p2, q);
  for (const bool of_file : {false, true}) {
    const std::string files =
        of_file ? file_of("orb-slam2.yaml") : (folder / "left.yaml") + "," + (folder / "right.yaml");
    if (of_file) {
      const cv::FileStorage settings(files, cv::FileStorage::READ);
      settings["LEFT.P"] >> p1;
      settings["RIGHT.P"] >> p2;
    }
    CHECK_FALSE(read_calibration(files).left.is_pinhole());
    const StereoCalibration rectified = read_calibration(files, true);
    CHECK(rectified.left.is_pinhole());
    CHECK(rectified.left.camera.fx == p1.at<double>(0, 0));
    CHECK(rectified.right.camera.cx == p2.at<double>(0, 2));
    CHECK(rectified.right.camera.width == 752);
    CHECK(rectified.right_from_left.linear().isIdentity());
    CHECK(rectified.right_from_left.translation().x() == Approx(p2.at<double>(0, 3) / p2.at<double>(0, 0)));
  }
  CHECK_THROWS_WITH(read_calibration(file_of("opencv.yaml"), true),
                    Contains("opencv.yaml") && Contains("projection matrices"));
}

TEST_CASE("calibration forms: settings of other cameras are not taken for rectified stereo") {
  const TemporaryFolder folder;
  const auto complaint = [&](const std::string& text) {
    write_text(folder / "file.txt", text);
    return message_of([&] { read_calibration(folder / "file.txt"); });
  };
  const std::string camera = "Camera.fx: 517\nCamera.fy: 516\nCamera.cx: 318\nCamera.cy: 255\nCamera.bf: 40\n";
  CHECK(complaint("%YAML:1.0\n" + camera + "Camera.k1: 0.0\n").empty());
  CHECK_THAT(complaint("%YAML:1.0\n" + camera + "DepthMapFactor: 5000\n"), Contains("depth camera"));
  CHECK_THAT(complaint("%YAML:1.0\n" + camera + "Camera.k1: 0.26\n"), Contains("Camera.k1") && Contains("rectified"));
  CHECK_THAT(complaint("Camera.setup: stereo\nCamera.cols: 752\nCamera.rows: 480\nCamera.focal_x_baseline: 40\n" +
                       camera + "Camera.k2: 0.1\n"),
             Contains("Camera.k2") && Contains("StereoRectifier"));
  CHECK_THAT(complaint(changed(text_of("realsense.output"), "Brown Conrady", "Inverse Brown Conrady")),
             Contains("inverse distortion"));
  const std::string skewed =
      "Camera2.fx: 517\nCamera2.fy: 516\nCamera2.cx: 318\nCamera2.cy: 255\n"
      "Tlr: !!opencv-matrix\n   rows: 3\n   cols: 4\n   dt: d\n   data: [1, 0.1, 0, 0.1, 0, 1, 0, 0, 0, 0, 1, 0]\n";
  CHECK_THAT(complaint("%YAML:1.0\n" + camera + skewed), Contains("Tlr") && Contains("orthonormal"));
}

TEST_CASE("calibration forms: KITTI-360's K ends in 0, KITTI's calib.txt has projections only") {
  const TemporaryFolder folder;
  const std::string text = changed(text_of("kitti.calib"), "248.375  0  0  1", "248.375  0  0  0");
  write_text(folder / "perspective.txt", changed(text, "255.238  0  0  1", "255.238  0  0  0"));
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
