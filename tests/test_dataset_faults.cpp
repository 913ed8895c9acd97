#include <algorithm>
#include <catch2/catch.hpp>
#include <sys/stat.h>

#include "dataset_files.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/error.hpp"
#include "temporary_folder.hpp"

using namespace quadedge;
using namespace dataset_files;
using Catch::Matchers::Contains;

namespace {

/// Opening and checking must both report `file` and what was expected.
void check_fault(const std::string& folder, const std::string& file, const std::string& found) {
  CHECK_THROWS_AS(open_dataset(folder), DataError);
  CHECK_THROWS_WITH(open_dataset(folder), Contains(file) && Contains(found) && Contains("expected"));
  const DatasetCheck check = check_dataset(folder);
  CHECK(std::any_of(check.errors.begin(), check.errors.end(), [&](const std::string& error) {
    return error.find(file) != std::string::npos && error.find(found) != std::string::npos;
  }));
}

}  // namespace

TEST_CASE("dataset: an error about an empty or missing folder names it and the known layouts", "[dataset]") {
  const TemporaryFolder folder;
  check_fault(folder.path(), folder.path(), "an empty folder");
  check_fault(folder / "absent", "absent", "no such folder");
  write_text(folder / "holiday.mov", "");
  check_fault(folder.path(), folder.path(), "holiday.mov");
  check_fault(folder / "holiday.mov", "holiday.mov", "a file");
  CHECK_THROWS_WITH(open_dataset(folder.path()), Contains("euroc") && Contains("middlebury-2014"));
}

TEST_CASE("dataset: a missing right image is named", "[dataset]") {
  const TemporaryFolder folder;
  const std::string kitti = write_kitti(folder / "k");
  std::filesystem::remove(kitti + "/image_1/000002.png");
  check_fault(kitti, "image_1/000002.png", "no such file");
  const std::string euroc = write_euroc(folder / "e");
  std::filesystem::remove(euroc + "/mav0/cam1/data/1403715273362143104.png");
  check_fault(euroc, "cam1/data/1403715273362143104.png", "no such file");
  const std::string eth3d = write_eth3d_slam(folder / "s");
  std::filesystem::remove(eth3d + "/rgb/12.325000001.png");
  check_fault(eth3d, "rgb/12.325000001.png", "no such file");
  write_image(folder / "m/im2.png");
  check_fault(folder / "m", "im6.png", "no such file");
  write_image(folder / "q/I1p.png");
  check_fault(folder / "q", "I2p.png", "no such file");
}

TEST_CASE("dataset: different numbers of left and right images are an error", "[dataset]") {
  const TemporaryFolder folder;
  const std::string kitti = write_kitti(folder / "k");
  write_image(kitti + "/image_1/000009.png");
  check_fault(kitti, "image_1", "5 images");
  const std::string eth3d = write_eth3d_slam(folder / "s");
  write_image(eth3d + "/rgb2/13.0.png");
  check_fault(eth3d, "rgb2", "5 images");
  const std::string euroc = write_euroc(folder / "e");
  write_text(euroc + "/mav0/cam1/data.csv", "1403715273312143104,1403715273312143104.png\n");
  check_fault(euroc, "cam1/data.csv", "1 timestamp in common");
}

TEST_CASE("dataset: errors about unreadable calibrations name the file and the value", "[dataset]") {
  const TemporaryFolder folder;
  const std::string kitti = write_kitti(folder / "k"), calib = kitti + "/calib.txt", good = read_text(calib);
  write_text(calib, "P0: 100 0 15 0 0 100 11 0 0 0 1\n");
  check_fault(kitti, "calib.txt:1", "11 numbers");
  write_text(calib, "P0: 100 0 15 0 0 1oo 11 0 0 0 1 0\n");
  check_fault(kitti, "calib.txt:1", "\"1oo\"");
  write_text(calib, good.substr(0, good.find("P1")));
  check_fault(kitti, "calib.txt", "no entry P1");
  std::filesystem::remove(calib);
  check_fault(kitti, "calib.txt", "a file that cannot be opened");
  const std::string euroc = write_euroc(folder / "e");
  write_text(euroc + "/mav0/cam1/sensor.yaml", "camera_model: pinhole\n");
  check_fault(euroc, "cam1/sensor.yaml", "no entry distortion_model");
  write_text(euroc + "/mav0/cam1/sensor.yaml", "camera_model: fisheye\n");
  check_fault(euroc, "cam1/sensor.yaml:1", "\"fisheye\" for camera_model");
  const std::string eth3d = write_eth3d_slam(folder / "s");
  write_text(eth3d + "/calibration2.txt", "40 40 15\n");
  check_fault(eth3d, "calibration2.txt:1", "3 columns");
  write_text(eth3d + "/calibration2.txt", "-40 40 15 11\n");
  check_fault(eth3d, "left camera", "focal length fx of -40");
  for (const char* name : {"m/im0.png", "m/im1.png"}) write_image(folder / name);
  write_text(folder / "m/calib.txt", "cam0=[50 0 20; 0 51]\n");
  check_fault(folder / "m", "calib.txt:1", "[50 0 20; 0 51]");
  write_text(folder / "m/calib.txt", "cam0=[50 0 20; 0 51 15; 0 0 1]\n");
  check_fault(folder / "m", "calib.txt", "no entry cam1");
}

TEST_CASE("dataset: a damaged sensor.yaml is refused with the key or the line", "[dataset]") {
  const TemporaryFolder folder;
  const std::string euroc = write_euroc(folder.path()), yaml = euroc + "/mav0/cam0/sensor.yaml", good = read_text(yaml);
  const auto damaged = [&](const std::string& from, const std::string& to, const std::string& place,
                           const std::string& found) {
    INFO(found);
    REQUIRE(good.find(from) != std::string::npos);
    write_text(yaml, std::string(good).replace(good.find(from), from.size(), to));
    check_fault(euroc, "cam0/sensor.yaml" + place, found);
  };
  damaged("[32, 24]", "[32, 24", ":", "not YAML");
  damaged("cols: 4", "cols: 4\n   rows: 4", ":", "not YAML");
  damaged("T_BS:", "T_SB:", "", "no entry T_BS");
  damaged("data:", "date:", "", "no entry T_BS.data");
  damaged("resolution:", "#resolution:", "", "no entry resolution");
  damaged("intrinsics: [30.0,", "intrinsics: [", ":13", "3 numbers for intrinsics");
  damaged("[32, 24]", "[32, 24, 1]", ":11", "3 numbers for resolution");
  damaged("[32, 24]", "32", ":11", "no list for resolution");
  damaged("[32, 24]", "[32, [24]]", ":11", "\"\"");
  damaged("[32, 24]", "[32, .nan]", ":11", "\".nan\"");
  damaged("31.0", "31,0", ":13", "5 numbers for intrinsics");
  damaged("camera_model: pinhole", "camera_model: [pinhole]", ":12", "\"\" for camera_model");
  damaged("0.0, -1.0, 0.0, 0.0,", "0.0, -1.0, 0.0,", ":6", "15 numbers for T_BS.data");
  write_text(yaml, "");
  check_fault(euroc, "cam0/sensor.yaml", "no entries");
  write_text(yaml, "all: &all {camera_model: pinhole, again: *all}\n");
  check_fault(euroc, "cam0/sensor.yaml", "no entry camera_model");
  write_text(yaml, "- camera_model: pinhole\n");
  check_fault(euroc, "cam0/sensor.yaml", "no entries");
  write_text(yaml, std::string("\x89PNG\0\xff: [", 9));
  check_fault(euroc, "cam0/sensor.yaml", "expected the sensor.yaml of a EuRoC camera");
}

TEST_CASE("dataset: a baseline that is zero or NaN is an error", "[dataset]") {
  const TemporaryFolder folder;
  const std::string kitti = write_kitti(folder / "k");
  write_text(kitti + "/calib.txt", "P0: 100 0 15 0 0 100 11 0 0 0 1 0\nP1: 100 0 15 0 0 100 11 0 0 0 1 0\n");
  check_fault(kitti, kitti, "baseline of 0.0");
  write_text(kitti + "/calib.txt", "P0: 100 0 15 0 0 100 11 0 0 0 1 0\nP1: 100 0 15 nan 0 100 11 0 0 0 1 0\n");
  check_fault(kitti, "calib.txt:2", "\"nan\"");
  StereoRig rig;
  rig.left = rig.right = {100, 100, 15, 11, 32, 24};
  rig.right_from_left.translation() << std::nan(""), 0, 0;
  CHECK_THROWS_WITH(check_rig(rig, "some.txt"), Contains("some.txt") && Contains("baseline of nan"));
  rig.right_from_left.translation() << -0.5, 0, 0;
  CHECK_NOTHROW(check_rig(rig, "some.txt"));
  rig.right_from_left.linear()(0, 1) = 0.01;
  CHECK_THROWS_WITH(check_rig(rig, "some.txt"), Contains("orthonormal"));
  rig.right_from_left.linear() = Eigen::Vector3d(1, 1, -1).asDiagonal();
  CHECK_THROWS_WITH(check_rig(rig, "some.txt"), Contains("right-handed"));
}

TEST_CASE("dataset: extrinsics without a valid rotation are an error", "[dataset]") {
  const TemporaryFolder folder;
  const std::string eth3d = write_eth3d_slam(folder / "s");
  write_text(eth3d + "/extrinsics_1_2.txt", "1 0.1 0 -0.09\n0 1 0 0\n0 0 1 0\n");
  check_fault(eth3d, "extrinsics_1_2.txt", "orthonormal");
  write_text(eth3d + "/extrinsics_1_2.txt", "1 0 0 -0.09\n0 1 0 0\n");
  check_fault(eth3d, "extrinsics_1_2.txt", "2 rows");
  const std::string euroc = write_euroc(folder / "e"), yaml = euroc + "/mav0/cam0/sensor.yaml";
  std::string text = read_text(yaml);
  write_text(yaml, text.replace(text.find("-1.0"), 4, "-1.2"));
  check_fault(euroc, "cam0/sensor.yaml:6 (T_BS.data)", "orthonormal");
}

TEST_CASE("dataset: timestamps out of order are an error", "[dataset]") {
  const TemporaryFolder folder;
  const std::string kitti = write_kitti(folder / "k");
  write_text(kitti + "/times.txt", "0\n0.2\n0.1\n0.3\n");
  check_fault(kitti, "image_0/000002.png", "0.100000000 after 0.200000000");
  write_text(kitti + "/times.txt", "0\n0.1\n0.1\n0.3\n");
  check_fault(kitti, "image_0/000002.png", "0.100000000 after 0.100000000");
  write_text(kitti + "/times.txt", "0\n0.1\n");
  check_fault(kitti, "times.txt", "2 rows");
  const std::string eth3d = write_eth3d_slam(folder / "s");
  write_text(eth3d + "/groundtruth.txt", "2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n");
  check_fault(eth3d, "groundtruth.txt:2", "1.000000000 after 2.000000000");
}

TEST_CASE("dataset: errors about malformed rows name the line", "[dataset]") {
  const TemporaryFolder folder;
  const std::string kitti = write_kitti(folder / "k");
  write_text(kitti + "/times.txt", "0\n0.1\n\n0.2 s\n0.3\n");
  check_fault(kitti, "times.txt:4", "2 columns");
  const std::string euroc = write_euroc(folder / "e"), list = euroc + "/mav0/cam0/data.csv", good = read_text(list);
  write_text(list, good + "14037x,a.png\n");
  check_fault(euroc, "cam0/data.csv:6", "\"14037x\"");
  write_text(list, good + std::string("\x01\xff\x00garbage", 10) + "\n");
  check_fault(euroc, "cam0/data.csv:6", "garbage");
  write_text(list, good);
  write_text(euroc + "/mav0/state_groundtruth_estimate0/data.csv", "1,2,3\n");
  check_fault(euroc, "state_groundtruth_estimate0/data.csv:1", "1,2,3");
  const std::string eth3d = write_eth3d_slam(folder / "s");
  write_text(eth3d + "/rgb.txt", "12.0 rgb/12.0.png extra\n");
  check_fault(eth3d, "rgb.txt:1", "extra");
}

TEST_CASE("dataset: duplicate entries and paths outside the folder are refused with their line", "[dataset]") {
  const std::string stamp = "1403715273312143104";
  struct Fault {
    std::string file;  ///< below the folder of the recording
    std::string from, to;
    std::string place, found;
  };
  const TemporaryFolder folder;
  const std::string kitti = write_kitti(folder / "k"), euroc = write_euroc(folder / "e"), pair = folder / "m";
  for (const char* name : {"/im0.png", "/im1.png"}) write_image(pair + name);
  write_text(pair + "/calib.txt",
             "cam0=[50 0 20; 0 51 15; 0 0 1]\ncam1=[50 0 20; 0 51 15; 0 0 1]\nbaseline=100\nwidth=32\nheight=24\n");
  const std::string list = euroc + "/mav0/cam0/data.csv", yaml = euroc + "/mav0/cam1/sensor.yaml";
  for (const auto& [file, from, to, place, found] :
       std::vector<Fault>{{kitti + "/calib.txt", "P2:", "P0:", "calib.txt:3", "a second entry P0"},
                          {pair + "/calib.txt", "cam1=", "cam0=", "calib.txt:2", "a second entry cam0"},
                          {pair + "/calib.txt", "width=32", "width=32.5", "calib.txt:4", "32.5"},
                          {pair + "/calib.txt", "width=32", "width=1e300", "calib.txt:4", "1e300"},
                          {yaml, "rate_hz: 20", "resolution: [30, 20]", "sensor.yaml:11", "a second entry resolution"},
                          {yaml, "cols: 4", "rows: 4", "sensor.yaml:5", "a second entry rows"},
                          {list, "1403715273362143104,", stamp + ",", "data.csv:3", "timestamp " + stamp + " again"},
                          {list, "," + stamp + ".png", ",../data/" + stamp + ".png", "data.csv:2", "../data/"},
                          {list, "," + stamp + ".png", "," + list, "data.csv:2", "/cam0/"},
                          {list, "," + stamp + ".png", ",..", "data.csv:2", "\"..\""}}) {
    INFO(file << " " << to);
    const std::string good = read_text(file);
    REQUIRE(good.find(from) != std::string::npos);
    write_text(file, std::string(good).replace(good.find(from), from.size(), to));
    check_fault(file.rfind(euroc, 0) == 0 ? euroc : file.rfind(kitti, 0) == 0 ? kitti : pair, place, found);
    write_text(file, good);
  }
  for (const auto& recording : {kitti, euroc, pair}) CHECK_NOTHROW(open_dataset(recording));
}

TEST_CASE("dataset: an impossible resolution is refused before tables of that size are allocated", "[dataset]") {
  const TemporaryFolder folder;
  const std::string euroc = write_euroc(folder.path()), yaml = euroc + "/mav0/cam0/sensor.yaml", good = read_text(yaml);
  for (const auto& [resolution, found] :
       {std::pair<const char*, const char*>{"[60000, 60000]", "found a focal length fx of 30"},
        {"[24, 32]", "found 32 x 24 pixels, expected 24 x 32"},
        {"[70000, 24]", "a resolution of 70000 x 24"},
        {"[32.5, 24]", "a resolution of 32.5 x 24"},
        {"[-32, 24]", "a resolution of -32 x 24"},
        {"[1e300, 24]", "x 24"}}) {
    INFO(resolution);
    write_text(yaml, std::string(good).replace(good.find("[32, 24]"), 8, resolution));
    CHECK_THROWS_WITH(open_dataset(euroc), Contains(found) && Contains("cam0"));
    CHECK_FALSE(check_dataset(euroc).errors.empty());
  }
}

TEST_CASE("dataset: implausible calibrations are refused by file name, whatever the search range", "[dataset]") {
  const TemporaryFolder folder;
  const std::string kitti = write_kitti(folder / "k");
  struct Row {
    std::string f, tx, found;
  };
  for (const auto& [f, tx, found] : {Row{"1e300", "-1e300", "focal length"},
                                     {"100", "-1e11", "baseline"},
                                     {"1e9", "-1e9", "focal length"},
                                     {"1e300", "-1e-300", "focal length"}}) {
    INFO(f << " " << tx);
    write_text(kitti + "/calib.txt",
               "P0: " + f + " 0 15 0 0 100 11 0 0 0 1 0\nP1: " + f + " 0 15 " + tx + " 0 100 11 0 0 0 1 0\n");
    CHECK_THROWS_WITH(open_dataset(kitti), Contains("calib.txt") && Contains(found) && !Contains("stereo."));
    CHECK_THROWS_AS(open_dataset(kitti), DataError);
  }
}

TEST_CASE("dataset: a byte order mark in front of a text file is skipped", "[dataset]") {
  const TemporaryFolder folder;
  const std::string kitti = write_kitti(folder / "k"), euroc = write_euroc(folder / "e"),
                    eth3d = write_eth3d_slam(folder / "s");
  for (const std::string& recording : {kitti, euroc, eth3d}) REQUIRE_NOTHROW(open_dataset(recording));
  for (const std::string& file :
       {kitti + "/calib.txt", kitti + "/times.txt", folder / "k/poses/07.txt", euroc + "/mav0/cam0/sensor.yaml",
        euroc + "/mav0/cam1/data.csv", euroc + "/mav0/state_groundtruth_estimate0/data.csv", eth3d + "/rgb.txt",
        eth3d + "/calibration.txt", eth3d + "/extrinsics_1_2.txt", eth3d + "/groundtruth.txt"}) {
    INFO(file);
    const std::string good = read_text(file);
    write_text(file, "\xEF\xBB\xBF" + good);
    for (const std::string& recording : {kitti, euroc, eth3d}) CHECK_NOTHROW(open_dataset(recording));
    write_text(file, good);
  }
  const std::string yaml = euroc + "/mav0/cam0/sensor.yaml";
  write_text(yaml, "\xEF\xBB\xBF%YAML:1.0\n" + read_text(yaml));
  CHECK(open_dataset(euroc).rig.left.width == 32);
}

TEST_CASE("dataset: a pipe or a device instead of a file is refused without waiting", "[dataset]") {
  const TemporaryFolder folder;
  const std::string kitti = write_kitti(folder / "k"), euroc = write_euroc(folder / "e"),
                    eth3d = write_eth3d_slam(folder / "s");
  for (const auto& [recording, file] : {std::pair<std::string, std::string>{kitti, "calib.txt"},
                                        {kitti, "times.txt"},
                                        {euroc, "mav0/cam0/sensor.yaml"},
                                        {euroc, "mav0/cam1/data.csv"},
                                        {eth3d, "rgb.txt"},
                                        {eth3d, "calibration2.txt"},
                                        {eth3d, "groundtruth.txt"}}) {
    INFO(file);
    const std::string path = recording + "/" + file;
    std::filesystem::rename(path, path + ".good");
    REQUIRE(mkfifo(path.c_str(), 0600) == 0);
    check_fault(recording, file, "a pipe");
    std::filesystem::remove(path);
    std::filesystem::create_symlink("/dev/zero", path);
    check_fault(recording, file, "a device");
    std::filesystem::remove(path);
    std::filesystem::rename(path + ".good", path);
  }
}

TEST_CASE("dataset: a check lists all errors, not only the first", "[dataset]") {
  const TemporaryFolder folder;
  const std::string kitti = write_kitti(folder.path());
  std::filesystem::remove(kitti + "/image_1/000001.png");
  truncate(kitti + "/image_0/000000.png", 0.5);
  write_image(kitti + "/image_1/000003.png", 40, 24);
  write_text(kitti + "/calib.txt", "P0: nonsense\n");
  write_text(folder / "poses/07.txt", "1 0 0\n");
  const DatasetCheck check = check_dataset(kitti);
  for (const char* part :
       {"image_1/000001.png", "image_0/000000.png", "image_1: found 3 images", "calib.txt:1", "07.txt:1"}) {
    INFO(part);
    CHECK(std::count_if(check.errors.begin(), check.errors.end(),
                        [&](const std::string& error) { return error.find(part) != std::string::npos; }) >= 1);
  }
}

TEST_CASE("dataset: ground truth for half of the frames and gaps are warnings", "[dataset]") {
  const TemporaryFolder folder;
  const std::string kitti = write_kitti(folder.path(), 6);
  write_text(kitti + "/times.txt", "0\n0.1\n0.2\n0.3\n0.7\n0.8\n");
  write_text(folder / "poses/07.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 1\n1 0 0 0 0 1 0 0 0 0 1 2\n");
  CHECK(open_dataset(kitti).truth.size() == 3);
  const DatasetCheck check = check_dataset(kitti);
  CHECK(check.errors.empty());
  REQUIRE(check.warnings.size() == 2);
  CHECK_THAT(check.warnings[0], Contains("gap of 0.400 s") && Contains("frame 4"));
  CHECK_THAT(check.warnings[1], Contains("poses/07.txt") && Contains("3 of 6"));
}
