#include "dataset_files.hpp"

using namespace quadedge;
using namespace dataset_files;
using Catch::Matchers::Contains;

namespace {

/// Opening and checking must both report `file` and what was expected.
void check_fault(const std::string& folder, const std::string& file, const std::string& found) {
  CHECK_THROWS_AS(open_dataset(folder), DataError);
  CHECK_THROWS_WITH(open_dataset(folder),
                    Contains(file) && Contains(found) && Contains("expected") && !Contains("stereo."));
  const DatasetCheck check = check_dataset(folder);
  CHECK(std::any_of(check.errors.begin(), check.errors.end(), [&](const std::string& error) {
    return error.find(file) != std::string::npos && error.find(found) != std::string::npos;
  }));
}

using Damage = std::function<void(const std::string& path)>;
Damage text(const std::string& whole) {
  return [=](const std::string& path) { write_text(path, whole); };
}
Damage change(const std::string& from, const std::string& to) {
  return [=](const std::string& path) {
    const std::string good = read_text(path);
    REQUIRE(good.find(from) != std::string::npos);
    write_text(path, std::string(good).replace(good.find(from), from.size(), to));
  };
}
Damage more(const std::string& end) {
  return [=](const std::string& path) { write_text(path, read_text(path) + end); };
}
/// KITTI's calibration with this focal length and this fourth column of P1.
Damage kitti_rig(const std::string& f, const std::string& tx) {
  return text("P0: " + f + " 0 15 0 0 100 11 0 0 0 1 0\nP1: " + f + " 0 15 " + tx + " 0 100 11 0 0 0 1 0\n");
}
void missing(const std::string& path) { std::filesystem::remove(path); }
void one_more_image(const std::string& path) { write_image(path); }

/// Two images of Middlebury's with their calibration.
std::string write_pair(const std::string& folder) {
  for (const char* name : {"/im0.png", "/im1.png"}) write_image(folder + name);
  write_text(folder + "/calib.txt",
             "cam0=[50 0 20; 0 51 15; 0 0 1]\ncam1=[50 0 20; 0 51 15; 0 0 1]\nbaseline=100\nwidth=32\nheight=24\n");
  return folder;
}
std::string kitti(const std::string& folder) { return write_kitti(folder); }
std::string euroc(const std::string& folder) { return write_euroc(folder); }
std::string eth3d(const std::string& folder) { return write_eth3d_slam(folder); }
std::string images(const std::string& folder) { return folder; }

struct Fault {
  std::string (*recording)(const std::string& folder);
  std::string file;  ///< of the recording
  Damage damage;
  std::string place, found;  ///< of the error
};

const std::string kStamp = "1403715273312143104", kRight = "mav0/cam1/data/1403715273362143104.png",
                  kYaml = "mav0/cam0/sensor.yaml", kYaml1 = "mav0/cam1/sensor.yaml", kList = "mav0/cam0/data.csv";

const std::vector<Fault> kFaults = {
    {kitti, "image_1/000002.png", missing, "image_1/000002.png", "no such file"},
    {euroc, kRight, missing, "cam1/data/1403715273362143104.png", "no such file"},
    {eth3d, "rgb/12.325000001.png", missing, "rgb/12.325000001.png", "no such file"},
    {images, "im2.png", one_more_image, "im6.png", "no such file"},
    {images, "I1p.png", one_more_image, "I2p.png", "no such file"},
    {kitti, "image_1/000009.png", one_more_image, "image_1", "5 images"},
    {eth3d, "rgb2/13.0.png", one_more_image, "rgb2", "5 images"},
    {euroc, "mav0/cam1/data.csv", text(kStamp + "," + kStamp + ".png\n"), "cam1/data.csv", "1 timestamp in common"},
    // Calibrations.
    {kitti, "calib.txt", text("P0: 100 0 15 0 0 100 11 0 0 0 1\n"), "calib.txt:1", "11 numbers"},
    {kitti, "calib.txt", text("P0: 100 0 15 0 0 1oo 11 0 0 0 1 0\n"), "calib.txt:1", "\"1oo\""},
    {kitti, "calib.txt", text("P0: 100 0 15 0 0 100 11 0 0 0 1 0\n"), "calib.txt", "no entry P1"},
    {kitti, "calib.txt", kitti_rig("100", "0"), "/07", "baseline of 0.0"},
    {kitti, "calib.txt", kitti_rig("100", "nan"), "calib.txt:2", "\"nan\""},
    // Implausible, whatever the search range.
    {kitti, "calib.txt", kitti_rig("1e300", "-1e300"), "calib.txt", "focal length"},
    {kitti, "calib.txt", kitti_rig("100", "-1e11"), "calib.txt", "baseline"},
    {kitti, "calib.txt", kitti_rig("1e9", "-1e9"), "calib.txt", "focal length"},
    {kitti, "calib.txt", kitti_rig("1e300", "-1e-300"), "calib.txt", "focal length"},
    {kitti, "calib.txt", missing, "calib.txt", "a file that cannot be opened"},
    {kitti, "calib.txt", change("P2:", "P0:"), "calib.txt:3", "a second entry P0"},
    {euroc, kYaml1, text("camera_model: pinhole\n"), "cam1/sensor.yaml", "no entry distortion_model"},
    {euroc, kYaml1, text("camera_model: fisheye\n"), "cam1/sensor.yaml:1", "\"fisheye\" for camera_model"},
    {euroc, kYaml1, change("rate_hz: 20", "resolution: [30, 20]"), "sensor.yaml:11", "a second entry resolution"},
    {euroc, kYaml1, change("cols: 4", "rows: 4"), "sensor.yaml:5", "a second entry rows"},
    {eth3d, "calibration2.txt", text("40 40 15\n"), "calibration2.txt:1", "3 columns"},
    {eth3d, "calibration2.txt", text("-40 40 15 11\n"), "left camera", "focal length fx of -40"},
    {eth3d, "extrinsics_1_2.txt", text("1 0.1 0 -0.09\n0 1 0 0\n0 0 1 0\n"), "extrinsics_1_2.txt", "orthonormal"},
    {eth3d, "extrinsics_1_2.txt", text("1 0 0 -0.09\n0 1 0 0\n"), "extrinsics_1_2.txt", "2 rows"},
    {eth3d, "extrinsics_1_2.txt", text("1 0 0 0\n0 1 0 0\n0 0 1 0\n"), "extrinsics_1_2.txt", "baseline"},
    {eth3d, "extrinsics_1_2.txt", text("1 0 0 nan\n0 1 0 0\n0 0 1 0\n"), "extrinsics_1_2.txt:1", "\"nan\""},
    {eth3d, "extrinsics_1_2.txt", text("2 0 0 0.06\n0 1 0 0\n0 0 1 0\n"), "extrinsics_1_2.txt", "rotation"},
    {eth3d, "extrinsics_1_2.txt", text("1 0 0 0.06\n0 1 0\n0 0 1 0\n"), "extrinsics_1_2.txt:2", "3 columns"},
    {eth3d, "calibration2.txt", missing, "calibration2.txt", "a file that cannot be opened"},
    {eth3d, "calibration2.txt", text(""), "calibration2.txt", "0 rows"},
    {eth3d, "calibration2.txt", text("focal length: about right\n"), "calibration2.txt:1", "\"focal\""},
    {eth3d, "calibration2.txt", text("nan 43 14 12\n"), "calibration2.txt:1", "\"nan\""},
    {eth3d, "calibration2.txt", text("42 1e308 14 12\n"), "calibration2.txt", "fy of 1e+308"},
    {eth3d, "calibration2.txt", text("42 1e-300 14 12\n"), "calibration2.txt", "fy of 1e-300"},
    {eth3d, "calibration2.txt", text("42 43 1e308 12\n"), "calibration2.txt", "cx of 1e+308"},
    {eth3d, "calibration2.txt", text("42038.7 43.0387 14 12\n"), "calibration2.txt", "42038.7"},
    {write_pair, "calib.txt", text("cam0=[50 0 20; 0 51]\n"), "calib.txt:1", "[50 0 20; 0 51]"},
    {write_pair, "calib.txt", text("cam0=[50 0 20; 0 51 15; 0 0 1]\n"), "calib.txt", "no entry cam1"},
    {write_pair, "calib.txt", change("cam1=", "cam0="), "calib.txt:2", "a second entry cam0"},
    {write_pair, "calib.txt", change("width=32", "width=32.5"), "calib.txt:4", "32.5"},
    {write_pair, "calib.txt", change("width=32", "width=1e300"), "calib.txt:4", "1e300"},
    {euroc, kYaml, change("[32, 24]", "[32, 24"), "cam0/sensor.yaml:", "not YAML"},
    {euroc, kYaml, change("cols: 4", "cols: 4\n   rows: 4"), "cam0/sensor.yaml:", "not YAML"},
    // Sizes that are none, before tables of these sizes are allocated.
    {euroc, kYaml, change("[32, 24]", "[60000, 60000]"), "cam0", "found a focal length fx of 30"},
    {euroc, kYaml, change("[32, 24]", "[24, 32]"), "cam0", "found 32 x 24 pixels, expected 24 x 32"},
    {euroc, kYaml, change("[32, 24]", "[70000, 24]"), "cam0", "a resolution of 70000 x 24"},
    {euroc, kYaml, change("[32, 24]", "[32.5, 24]"), "cam0", "a resolution of 32.5 x 24"},
    {euroc, kYaml, change("[32, 24]", "[-32, 24]"), "cam0", "a resolution of -32 x 24"},
    {euroc, kYaml, change("[32, 24]", "[1e300, 24]"), "cam0", "x 24"},
    {euroc, kYaml, change("T_BS:", "T_SB:"), "cam0/sensor.yaml", "no entry T_BS"},
    {euroc, kYaml, change("data:", "date:"), "cam0/sensor.yaml", "no entry T_BS.data"},
    {euroc, kYaml, change("resolution:", "#resolution:"), "cam0/sensor.yaml", "no entry resolution"},
    {euroc, kYaml, change("intrinsics: [30.0,", "intrinsics: ["), "cam0/sensor.yaml:13", "3 numbers for intrinsics"},
    {euroc, kYaml, change("[32, 24]", "[32, 24, 1]"), "cam0/sensor.yaml:11", "3 numbers for resolution"},
    {euroc, kYaml, change("[32, 24]", "32"), "cam0/sensor.yaml:11", "no list for resolution"},
    {euroc, kYaml, change("[32, 24]", "[32, [24]]"), "cam0/sensor.yaml:11", "\"\""},
    {euroc, kYaml, change("[32, 24]", "[32, .nan]"), "cam0/sensor.yaml:11", "\".nan\""},
    {euroc, kYaml, change("31.0", "31,0"), "cam0/sensor.yaml:13", "5 numbers for intrinsics"},
    {euroc, kYaml, change("camera_model: pinhole", "camera_model: [pinhole]"), "sensor.yaml:12",
     "\"\" for camera_model"},
    {euroc, kYaml, change("0.0, -1.0, 0.0, 0.0,", "0.0, -1.0, 0.0,"), "sensor.yaml:6", "15 numbers for T_BS.data"},
    {euroc, kYaml, change("-1.0", "-1.2"), "cam0/sensor.yaml:6 (T_BS.data)", "orthonormal"},
    {euroc, kYaml, text(""), "cam0/sensor.yaml", "no entries"},
    {euroc, kYaml, text("all: &all {camera_model: pinhole, again: *all}\n"), "sensor.yaml", "no entry camera_model"},
    {euroc, kYaml, text("- camera_model: pinhole\n"), "cam0/sensor.yaml", "no entries"},
    {euroc, kYaml, text(std::string("\x89PNG\0\xff: [", 9)), "cam0/sensor.yaml",
     "expected the sensor.yaml of a EuRoC camera"},
    // Lists.
    {kitti, "times.txt", text("0\n0.2\n0.1\n0.3\n"), "image_0/000002.png", "0.100000000 after 0.200000000"},
    {kitti, "times.txt", text("0\n0.1\n0.1\n0.3\n"), "image_0/000002.png", "0.100000000 after 0.100000000"},
    {kitti, "times.txt", text("0\n0.1\n"), "times.txt", "2 rows"},
    {kitti, "times.txt", text("0\n0.1\n\n0.2 s\n0.3\n"), "times.txt:4", "2 columns"},
    {euroc, kList, more("14037x,a.png\n"), "cam0/data.csv:6", "\"14037x\""},
    {euroc, kList, more(std::string("\x01\xff\x00garbage", 10) + "\n"), "cam0/data.csv:6", "garbage"},
    {euroc, kList, change("1403715273362143104,", kStamp + ","), "data.csv:3", "timestamp " + kStamp + " again"},
    {euroc, kList, change("," + kStamp + ".png", ",../data/" + kStamp + ".png"), "data.csv:2", "../data/"},
    {euroc, kList, change("," + kStamp + ".png", ",/tmp/cam0/data.csv"), "data.csv:2", "/cam0/"},
    {euroc, kList, change("," + kStamp + ".png", ",.."), "data.csv:2", "\"..\""},
    {eth3d, "rgb.txt", text("12.0 rgb/12.0.png extra\n"), "rgb.txt:1", "extra"},
    {eth3d, "rgb.txt", text(""), "rgb.txt", "no "},
    {eth3d, "rgb.txt", change("12.325000001 rgb", "12.0 rgb"), "12.325000001", "12.000000000 after 12.225000001"},
    {eth3d, "rgb.txt", more("12.325000001 rgb/12.325000001.png\n"), "rgb2", "4 images"},
    {eth3d, "rgb.txt", more(std::string("\0001\n", 3)), "rgb.txt:6", "\"?1\""},
    {eth3d, "groundtruth.txt", text("somewhere in the room\n"), "groundtruth.txt:1", "4 columns"},
    {eth3d, "groundtruth.txt", text("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"), "groundtruth.txt:2",
     "1.000000000 after 2.000000000"},
    {euroc, "mav0/state_groundtruth_estimate0/data.csv", text("1,2,3\n"), "state_groundtruth_estimate0/data.csv:1",
     "1,2,3"},
};

}  // namespace

TEST_CASE("dataset: an error about an empty or missing folder names it and the known layouts") {
  const TemporaryFolder folder;
  check_fault(folder.path(), folder.path(), "an empty folder");
  check_fault(folder / "absent", "absent", "no such folder");
  write_text(folder / "holiday.mov", "");
  check_fault(folder.path(), folder.path(), "holiday.mov");
  check_fault(folder / "holiday.mov", "holiday.mov", "a file");
  CHECK_THROWS_WITH(open_dataset(folder.path()), Contains("euroc") && Contains("middlebury-2014"));
}

TEST_CASE("dataset: what is damaged is refused with its file, line and what was found") {
  for (const Fault& fault : kFaults) {
    const TemporaryFolder folder;
    const std::string recording = fault.recording(folder / "recording");
    INFO(fault.file << ": " << fault.found);
    if (fault.recording != images) REQUIRE_NOTHROW(open_dataset(recording));
    fault.damage(recording + "/" + fault.file);
    check_fault(recording, fault.place, fault.found);
  }
}

TEST_CASE("dataset: a byte order mark in front of a text file is skipped") {
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

TEST_CASE("dataset: a pipe or a device instead of a file is refused without waiting") {
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

TEST_CASE("dataset: a check lists all errors, not only the first") {
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

TEST_CASE("dataset: ground truth for half of the frames and gaps are warnings") {
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
