#include "calibration_files.hpp"

using namespace quadedge;
using namespace calibration_files;
using Catch::Matchers::Contains;
using dataset_files::real_data;
using dataset_files::write_image;

namespace {

constexpr int kFrames = 3;

/// Writes the images of two folders and returns their names.
void write_images(const std::string& left, const std::string& right, int width, int height) {
  for (int i = 0; i < kFrames; ++i) {
    char name[24];
    std::snprintf(name, sizeof name, "%010d.png", i + 4);
    write_image(left + "/" + name, width, height);
    write_image(right + "/" + name, width, height);
  }
}

}  // namespace

TEST_CASE("dataset: KITTI's raw layout has dated stamps, rectified cameras and OXTS as truth") {
  const TemporaryFolder folder;
  const std::string date = folder / "2011_09_26", drive = date + "/2011_09_26_drive_0001_sync";
  write_images(drive + "/image_00/data", drive + "/image_01/data", 62, 24);
  std::string times;
  for (int i = 0; i < 7; ++i) times += "2011-09-26 13:02:" + std::to_string(25 + i) + ".967790592\n";
  write_text(drive + "/image_00/timestamps.txt", times);
  write_text(date + "/calib_cam_to_cam.txt",
             "calib_time: 09-Jan-2012 13:57:47\nS_rect_00: 62 24\nR_rect_00: 1 0 0 0 1 0 0 0 1\n"
             "P_rect_00: 50 0 30 0 0 50 12 0 0 0 1 0\nS_rect_01: 62 24\nP_rect_01: 50 0 30 -25 0 50 12 0 0 0 1 0\n");
  // x_cam = (-y_imu, -z_imu, x_imu): a vehicle that faces along x.
  write_text(date + "/calib_imu_to_velo.txt", "R: 1 0 0 0 1 0 0 0 1\nT: 0 0 0\n");
  write_text(date + "/calib_velo_to_cam.txt", "R: 0 -1 0 0 0 -1 1 0 0\nT: 0 0 0\n");
  // Due north by 1e-5 degrees of latitude, 6378137 pi / 180 * 1e-5 m at the Mercator scale of the first packet.
  for (int i = 0; i < kFrames; ++i) {
    char name[24];
    std::snprintf(name, sizeof name, "/%010d.txt", i + 4);
    write_text(drive + "/oxts/data" + name, "49.0" + std::to_string(i) + " 8.4 100 0 0 1.5707963267948966 0 0\n");
  }
  for (const std::string& place : {date, drive}) {
    const Dataset dataset = open_dataset(place);
    CHECK(dataset.format == "kitti-raw");
    REQUIRE(dataset.frames.size() == kFrames);
    CHECK(dataset.frames[0].stamp_ns == 1317042149967790592);  // the fifth row: 13:02:29.967790592 UTC
    CHECK(dataset.rig.baseline() == Approx(0.5));
    CHECK(dataset.rig.left_undistortion.empty());
    REQUIRE(dataset.truth.size() == kFrames);
    const Eigen::Isometry3d step = dataset.truth[0].world_from_left.inverse() * dataset.truth[1].world_from_left;
    CHECK(step.translation().z() == Approx(0.01 * 6378137 * EIGEN_PI / 180).epsilon(1e-3));
    CHECK(std::abs(step.translation().x()) < 1e-6);
    CHECK(step.linear().isIdentity(1e-9));
  }
  write_text(drive + "/image_00/timestamps.txt", "2011-13-26 13:02:25\n");
  CHECK_THROWS_WITH(open_dataset(drive), Contains("timestamps.txt:1") && Contains("2011-13-26"));
}

TEST_CASE("dataset: TUM-VI as exported and as people cut it for DSO") {
  const TemporaryFolder folder;
  const Rig rig;
  const std::string chain = kalibr_chain(rig, "both");
  const std::string dso = folder / "dso", exported = folder / "exported";
  const std::vector<std::string> names = {"1520530308199447626", "1520530308249448626"};
  for (const char* camera : {"cam0", "cam1"}) {
    std::string times = "# filename timestamp[s] exposuretime[ms]\n", list = "#timestamp [ns],filename\n";
    for (const std::string& name : names) {
      write_image(dso + "/" + camera + "/images/" + name + ".png", 752, 480);
      write_image(exported + "/mav0/" + camera + "/data/" + name + ".png", 752, 480);
      times += name + " " + name.substr(0, 10) + "." + name.substr(10) + " 1.46\n";
      list += name + "," + camera + "/data/" + name + ".png\n";
    }
    write_text(dso + "/" + camera + "/times.txt", times);
    write_text(exported + "/mav0/" + camera + "/data.csv", list);
  }
  write_text(dso + "/camchain.yaml", chain);
  write_text(exported + "/dso/camchain.yaml", chain);
  write_text(
      exported + "/mav0/mocap0/data.csv",
      "#timestamp [ns], p_RS_R_x [m], ...\n1520530308199447626,1,2,3,1,0,0,0\n1520530308249448626,1,2,4,1,0,0,0\n");
  for (const std::string& place : {dso, exported}) {
    const Dataset dataset = open_dataset(place);
    REQUIRE(dataset.frames.size() == 2);
    CHECK(dataset.frames[1].stamp_ns == 1520530308249448626);
    CHECK(dataset.calibration->format == "kalibr");
    CHECK((dataset.rig.right_from_left.translation() - rig.right_from_left().translation()).norm() < 1e-8);
    if (place == dso) continue;
    REQUIRE(dataset.truth.size() == 2);
    const Eigen::Vector3d left = Eigen::Vector3d(1, 2, 3) + rig.body_from_left.translation();
    CHECK((dataset.truth[0].world_from_left.translation() - left).norm() < 1e-6);
  }
  std::filesystem::remove(dso + "/camchain.yaml");
  CHECK_THROWS_WITH(open_dataset(dso), Contains("sensor.yaml") && !Contains("image width"));
}

TEST_CASE("dataset: TartanAir's poses are those of the camera, z forward") {
  const TemporaryFolder folder;
  write_images(folder / "image_left", folder / "image_right", 64, 48);
  // North by a metre per frame, east by half: forward and to the right.
  write_text(folder / "pose_left.txt", "0 0 0 0 0 0 1\n1 0.5 0 0 0 0 1\n2 1 0.25 0 0 0 1\n");
  const Dataset dataset = open_dataset(folder / ".");
  CHECK(dataset.format == "tartanair");
  CHECK(dataset.rig.left.fx == 32);  // 320 px for 640, a field of view of 90 degrees
  CHECK(dataset.rig.left.cx == 32);
  CHECK(dataset.rig.baseline() == Approx(0.25));
  REQUIRE(dataset.truth.size() == kFrames);
  const Eigen::Isometry3d moved = dataset.truth[0].world_from_left.inverse() * dataset.truth[2].world_from_left;
  CHECK((moved.translation() - Eigen::Vector3d(1, 0.25, 2)).norm() < 1e-12);  // right, down, forward
}

TEST_CASE("dataset: one folder with the images of both cameras") {
  const TemporaryFolder folder;
  write_text(folder / "rig.yaml", kalibr_chain(Rig(), "both"));
  DatasetOptions options;
  options.calibration = folder / "rig.yaml";
  for (const auto& [left, right] :
       {std::pair("I1_00000$.png", "I2_00000$.png"), {"$_left.png", "$_right.png"}, {"left_$.png", "right_$.png"}}) {
    const std::string place = folder / std::string(left).substr(0, 3);
    for (const char number : {'2', '9'}) {
      for (std::string name : {left, right})
        write_image(place + "/" + name.replace(name.find('$'), 1, 1, number), 752, 480);
    }
    const Dataset dataset = open_dataset(place, options);
    REQUIRE(dataset.frames.size() == 2);
    CHECK(dataset.format == "paired-names");
    CHECK_THAT(dataset.frames[1].left, Contains("9"));
    CHECK(dataset.frames[1].stamp_ns - dataset.frames[0].stamp_ns == 100'000'000);
    CHECK_THROWS_WITH(open_dataset(place), Contains("without a calibration") && Contains("--calibration"));
  }
}

TEST_CASE("dataset: a rate that no camera has is a warning") {
  const TemporaryFolder folder;
  const std::string root = folder / "kitti";
  dataset_files::write_kitti(root, 3);
  write_text(root + "/sequences/07/times.txt", "0\n100\n200\n");
  const DatasetCheck check = check_dataset(root);
  CHECK(std::any_of(check.warnings.begin(), check.warnings.end(), [](const std::string& warning) {
    return warning.find("0.01 Hz") != std::string::npos && warning.find("--times") != std::string::npos;
  }));
}

TEST_CASE("dataset: real recordings in the layouts that people bring") {
  const std::string kitti = real_data("kitti_raw_layout"), fisheye = real_data("tumvi_room1_dso");
  if (kitti.empty() || fisheye.empty()) return;
  const Dataset drive = open_dataset(kitti + "/2011_09_26/2011_09_26_drive_0001_sync");
  CHECK(drive.frames.size() == 5);
  CHECK(drive.rig.baseline() == Approx(387.5744 / 721.5377));  // of calib_cam_to_cam.txt
  REQUIRE(drive.truth.size() == 5);
  const double metres =
      (drive.truth[1].world_from_left.inverse() * drive.truth[0].world_from_left).translation().norm();
  CHECK(metres == Approx(1.3).margin(0.3));  // 10 Hz at 13 m/s, as the packets' velocities say
  const Dataset room = open_dataset(fisheye);
  CHECK(room.frames.size() == 3);
  CHECK(room.rig.max_value == 65535);
  CHECK(room.rig.baseline() == Approx(0.101).epsilon(0.01));
}

TEST_CASE("dataset: KITTI-360 has rectified and recorded images of one size, KITTI's calib.txt other rows") {
  const TemporaryFolder folder;
  const std::string drive = folder / "data_2d_raw/2013_05_28_drive_0000_sync";
  for (const char* kind : {"data_rgb", "data_rect"}) {
    write_images(drive + "/image_00/" + kind, drive + "/image_01/" + kind, 62, 24);
    std::string times;
    for (int i = 0; i < 7; ++i) times += "2013-05-28 08:46:0" + std::to_string(i) + ".5\n";
    write_text(drive + "/image_00/timestamps.txt", times);
    write_text(folder / "calibration/perspective.txt",
               "S_00: 62 24\nK_00: 60 0 31 0 61 11 0 0 0\nD_00: 0 0 0 0 0\nR_00: 1 0 0 0 1 0 0 0 1\nT_00: 0 0 0\n"
               "S_01: 62 24\nK_01: 62 0 32 0 63 10 0 0 0\nD_01: 0 0 0 0 0\nR_01: 1 0 0 0 1 0 0 0 1\nT_01: -0.4 0.1 0\n"
               "S_rect_00: 62 24\nP_rect_00: 50 0 30 0 0 50 12 0 0 0 1 0\n"
               "S_rect_01: 62 24\nP_rect_01: 50 0 30 -30 0 50 12 0 0 0 1 0\n");
    const Dataset dataset = open_dataset(drive);
    CHECK(dataset.format == "kitti-raw");
    REQUIRE(dataset.frames.size() == kFrames);
    CHECK_THAT(dataset.frames[0].right, Contains(kind));
    CHECK(dataset.rig.left.fx == (kind == std::string("data_rect") ? 50 : 60));
    CHECK(dataset.rig.right_from_left.translation().x() == Approx(kind == std::string("data_rect") ? -0.6 : -0.4));
  }
  const std::string root = folder / "kitti", calibration = root + "/sequences/07/calib.txt";
  dataset_files::write_kitti(root, 3);
  const StereoRig rig = open_dataset(root).rig;
  std::ofstream(calibration, std::ios::app) << "R0_rect: 1 0 0 0 1 0 0 0 1\nTr_velo_to_cam: 1 0 0\ncalib_time 2012\n";
  CHECK(open_dataset(root).rig.right_from_left.matrix() == rig.right_from_left.matrix());
}

TEST_CASE("dataset: lists may name their columns in a first line without a comment sign") {
  const TemporaryFolder folder;
  const Rig rig;
  write_text(folder / "camchain.yaml", kalibr_chain(rig, "both"));
  for (const std::string camera : {"cam0", "cam1"}) {
    write_image(folder / (camera + "/data/a.png"), 752, 480);
    write_image(folder / (camera + "/data/b.png"), 752, 480);
    write_text(folder / (camera + "/data.csv"), "timestamp,filename\n1000000000,a.png\n1050000000,b.png\n");
  }
  CHECK(open_dataset(folder / ".").frames.size() == 2);
  for (const std::string camera : {"cam0", "cam1"}) {  // as Kalibr extracts bags
    write_image(folder / ("kalibr/" + camera + "/1403636584763555584.png"), 752, 480);
    write_image(folder / ("kalibr/" + camera + "/1403636584813555584.png"), 752, 480);
  }
  write_text(folder / "kalibr/camchain.yaml", kalibr_chain(rig, "both"));
  CHECK(open_dataset(folder / "kalibr").frames.at(1).stamp_ns == 1403636584813555584);
  write_text(folder / "seconds.csv", "timestamp,x,y,z,qw,qx,qy,qz\n1403636584.763555584,1,2,3,1,0,0,0\n");
  const Trajectory seconds = read_trajectory(folder / "seconds.csv");
  REQUIRE(seconds.size() == 1);
  CHECK(seconds[0].stamp_ns == 1403636584763555584);
  write_text(folder / "leica.csv", "#timestamp [ns],x,y,z\n1403636584763555584,1,2,3\n");
  CHECK_THROWS_WITH(read_trajectory(folder / "leica.csv"), Contains("without orientation") && Contains("vicon0"));
}

TEST_CASE("dataset: times beside images that cannot be read are replaced by --fps, with a warning") {
  const TemporaryFolder folder;
  for (const char* side : {"l", "r"}) {
    write_image(folder / (side + std::string("/a.png")), 752, 480);
    write_image(folder / (side + std::string("/b.png")), 752, 480);
  }
  write_text(folder / "times.txt", "exposures of 4 frames\n1 2 3 4\n");
  write_text(folder / "rig.yaml", kalibr_chain(Rig(), "both"));
  StereoSource source;
  source.left = folder / "l";
  source.right = folder / "r";
  source.calibration = folder / "rig.yaml";
  CHECK_THROWS_WITH(open_stereo_source(source), Contains("times.txt"));
  source.fps = 4;
  const Dataset dataset = open_stereo_source(source);
  REQUIRE(dataset.frames.size() == 2);
  CHECK(dataset.frames[1].stamp_ns == 250'000'000);
  REQUIRE(dataset.warnings.size() == 1);
  CHECK_THAT(dataset.warnings[0], Contains("times.txt") && Contains("--fps is used"));
}
