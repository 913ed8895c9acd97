#include <opencv2/imgcodecs.hpp>

#include "calibration_files.hpp"
#include "program.hpp"

using Catch::Matchers::Contains;
using dataset_files::real_data;

TEST_CASE("cli: an unsuitable calibration, field of view or mask is refused with its exit code", "[cli]") {
  const TemporaryFolder folder;
  const std::string flight = dataset_files::write_euroc(folder / "flight");
  const auto fails = [&](const Words& arguments, int code, const std::string& found) {
    check_error(Words{"run", flight, "-o", folder / "out"} + arguments, code, {found});
    CHECK_FALSE(std::filesystem::exists(folder / "out"));
  };
  const calibration_files::Rig rig;
  write_text(folder / "chain.yaml", calibration_files::kalibr_chain(rig, "T_imu_cam"));
  fails({"--calibration", folder / "chain.yaml"}, 3, "752 x 480");
  fails({"--calibration", folder / "absent.yaml"}, 3, "absent.yaml");
  fails({"--fov", "190"}, 2, "--fov");
  fails({"--mask", folder / "absent.png"}, 3, "absent.png");
  dataset_files::write_image(folder / "mask.png", 16, 24);
  fails({"--mask", folder / "mask.png"}, 3, "16 x 24");
  const std::string pinhole = dataset_files::write_kitti(folder / "k");
  check_error({"check", pinhole, "--fov", "90"}, 2);
  check_error({"synth", folder / "s", "--right-rotation", "0,2"}, 2);
  // The rig of a recording without lens distortion can be written too.
  run_well({"check", pinhole, "--quiet", "--write-calibration", folder / "kitti.yaml"});
  CHECK_THAT(read_text(folder / "kitti.yaml"),
             Contains("left_coefficients: []") && Contains("translation: [-0.5, 0, 0]"));
}

TEST_CASE("cli: KITTI's rectified images beside the cameras as they record are proposed as rectified", "[cli]") {
  const std::string drive = real_data("kitti_raw_layout");
  if (drive.empty()) return;
  const TemporaryFolder folder;
  const std::string date = drive + "/2011_09_26/";
  std::map<std::string, std::string> numbers;  // as kitti2bag takes them into camera_info
  std::istringstream lines(read_text(date + "calib_cam_to_cam.txt"));
  for (std::string line; std::getline(lines, line);) {
    std::replace(line.begin(), line.end(), ' ', ',');
    const std::size_t colon = line.find(":,");
    if (colon != std::string::npos) numbers[line.substr(0, colon)] = line.substr(colon + 2);
  }
  for (const std::string camera : {"00", "01"}) {
    write_text(folder / camera, "height: 375\nwidth: 1242\ndistortion_model: plumb_bob\nD: [" + numbers["D_" + camera] +
                                    "]\nK: [" + numbers["K_" + camera] + "]\nR: [" + numbers["R_rect_" + camera] +
                                    "]\nP: [" + numbers["P_rect_" + camera] + "]\n");
  }
  const std::string images = date + "2011_09_26_drive_0001_sync/image_";
  Words check = {"check",   "--left",           images + "00/data",
                 "--right", images + "01/data", "--fps",
                 "10",      "--calibration",    (folder / "00") + "," + (folder / "01")};
  CHECK_THAT(run_program(check).out, Contains("--rectified takes P"));
  CHECK_THAT(run_program(check + Words{"--rectified"}).out,
             !Contains("--rectified takes P") && !Contains("do not fit"));
}

TEST_CASE("check: few corners with a partner say nothing against a calibration whose lines they lie on", "[cli]") {
  const TemporaryFolder folder;
  const auto check_behind_board = [&](double height) {
    const std::string flight = folder / std::to_string(height);
    std::filesystem::copy(small_sequence(), flight, std::filesystem::copy_options::recursive);
    cv::RNG random(5);
    for (const char* camera : {"rgb", "rgb2"}) {  // a board so near that no search reaches its disparity
      const std::string file = flight + "/" + camera + "/0.100000000.png";
      cv::Mat image = cv::imread(file, cv::IMREAD_GRAYSCALE);
      cv::Mat dots(image.size(), CV_8UC1);
      random.fill(dots, cv::RNG::UNIFORM, 0, 256);
      const cv::Rect board(0, 0, image.cols, static_cast<int>(height * image.rows));
      dots(board).copyTo(image(board));
      cv::imwrite(file, image);
    }
    return run_program({"check", flight}).out;
  };
  CHECK_THAT(check_behind_board(0.82), Contains("% of these on their line") && Contains("0 errors, 0 warnings"));
  CHECK_THAT(check_behind_board(1), Contains("frame 2: the images do not fit the calibration"));
}
