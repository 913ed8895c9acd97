#include "calibration_texts.hpp"

using namespace quadedge;
using namespace calibration_files;
using Catch::Matchers::Contains;

TEST_CASE("calibration form variants: a ZED camera's resolutions, and OAK's by scaling and cropping") {
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
  write_text(folder / "oak.json",
             changed(text_of("depthai.json"), "\"height\": 480, \"width\": 752", "\"height\": 800, \"width\": 1280"));
  StereoCalibration cropped = read_calibration(folder / "oak.json"), halved = cropped;
  data::set_image_sizes(cropped, {1280, 720}, {1280, 720}, "the images");
  CHECK(cropped.left.camera.fx == 458.654);
  CHECK(cropped.left.camera.cy == Approx(248.375 - 40));
  data::set_image_sizes(halved, {640, 400}, {640, 400}, "the images");
  CHECK(halved.right.camera.fy == Approx(456.134 / 2));
  CHECK(halved.right.camera.cx == Approx(379.999 / 2));
}

TEST_CASE("calibration form variants: region of interest and binning of camera_info") {
  const TemporaryFolder folder;
  for (const std::string side : {"left", "right"}) {
    const std::string text = text_of("camera_info_" + side + ".yaml");
    write_text(folder / side,
               text.substr(0, text.find("binning_x")) +
                   "binning_x: 2\nbinning_y: 2\nroi:\n  x_offset: 8\n  y_offset: 4\n  width: 736\n  height: 472\n");
  }
  const Lens lens = read_calibration((folder / "left") + "," + (folder / "right")).left;
  CHECK(lens.camera.fx == Approx(458.654 / 2));
  CHECK(lens.camera.cx == Approx((367.215 - 8) / 2));
  CHECK(lens.camera.cy == Approx((248.375 - 4) / 2));
  CHECK(lens.camera.width == 368);
  CHECK(lens.camera.height == 236);
}

TEST_CASE("calibration form variants: names of left and right, and models that other programs write") {
  const TemporaryFolder folder;
  std::string named = text_of("opencv.yaml");
  for (const auto& [from, to] : {std::pair("K1", "cameraMatrixL"), std::pair("D1", "distCoeffsL"),
                                 std::pair("K2", "cameraMatrixR"), std::pair("D2", "distCoeffsR")})
    named = changed(named, from, to);
  write_text(folder / "named.yaml", named);
  check_rig(read_calibration(folder / "named.yaml"), 3e-9);
  for (const std::string camera : {"vins_cam0.yaml", "vins_cam1.yaml"})
    write_text(folder / camera, changed(changed(text_of(camera), "PINHOLE", "PINHOLE_FULL"),
                                        "   p1:", "   k3: 0.01\n   k4: 0.02\n   k5: 0.03\n   k6: 0.04\n   p1:"));
  write_text(folder / "config.yaml", text_of("vins-fusion.yaml"));
  CHECK(read_calibration(folder / "config.yaml").left.parameters ==
        std::vector<double>{-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05, 0.01, 0.02, 0.03, 0.04});
  std::string unified = changed(text_of("basalt.json"), "pinhole-radtan8", "ucm");
  for (std::size_t at = 0; (at = unified.find("\"k1\": ", at)) != std::string::npos;)
    unified.replace(at, unified.find(',', at) - at, "\"alpha\": 0.6");
  write_text(folder / "ucm.json", unified);
  CHECK(read_calibration(folder / "ucm.json").left.parameters == std::vector<double>{0.6, 1});
}

TEST_CASE("calibration form variants: OpenCV's YAML has values without a space, as ORB-SLAM2's own settings") {
  const TemporaryFolder folder;
  const std::string text = changed(text_of("orb-slam2.yaml"), "data: [", "data:[");
  write_text(folder / "settings.yaml",
             text + "Viewer.PointSize:2\nTbc: !!opencv-matrix\n   rows: 1\n   cols: 2\n   data: [1.0 0.0]\n");
  const StereoCalibration read = read_calibration(folder / "settings.yaml");
  CHECK(read.format == "orb-slam");
  check_rig(read, 3e-9);
  write_text(folder / "other.yaml", "Camera.fx:2\nCamera.fy: 2\n");  // without OpenCV's header it is not OpenCV's YAML
  CHECK_THROWS_WITH(read_calibration(folder / "other.yaml"), Contains("other.yaml:2") && Contains("is not YAML"));
}

TEST_CASE("calibration form variants: a ZED camera's lens in a section of its own") {
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
  CHECK_THROWS_WITH(read(rational, "\n"), Contains("no entry RIGHT_CAM_FHD1200.K1"));
}

TEST_CASE("calibration form variants: MATLAB's numbers as displayed, in any order, in their own unit") {
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

TEST_CASE("calibration form variants: camera_info of both cameras in one file, and what it leaves out") {
  const TemporaryFolder folder;
  const std::string left = camera_info_of_ros2("left"), right = camera_info_of_ros2("right");
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

TEST_CASE("calibration form variants: words and wrappings that programs leave out or add") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& text, bool rectified = false) {
    write_text(folder / "file", text);
    return read_calibration(folder / "file", rectified);
  };
  const auto renamed = [&](std::initializer_list<std::pair<const char*, const char*>> names) {
    std::string text = text_of("opencv.yaml");
    for (const auto& [from, to] : names) text = changed(text, from, to);
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
  const std::string wrapped = text_of("basalt.json");
  check_rig(read(wrapped.substr(wrapped.find('{', 1), wrapped.rfind('}') - wrapped.find('{', 1))), 3e-9);
  std::string wide = "\xFF\xFE";  // as PowerShell redirects
  for (const char letter : text_of("realsense.output")) wide += std::string{letter, '\0'};
  check_rig(read(wide), 3e-9);
  CHECK_THROWS_WITH(read("Stream Profiles supported by Stereo Module\n"), Contains("rs-enumerate-devices -c"));
  const StereoCalibration rectified = read(text_of("stella-vslam.yaml"), true);
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
