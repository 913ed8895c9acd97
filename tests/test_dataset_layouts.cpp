#include "dataset_files.hpp"

using namespace quadedge;
using namespace dataset_files;
using Catch::Matchers::Contains;

TEST_CASE("dataset: a KITTI sequence is read from its folder and from the root") {
  const TemporaryFolder folder;
  const std::string sequence = write_kitti(folder.path());
  const Dataset set = open_dataset(sequence);
  CHECK(set.format == "kitti");
  REQUIRE(set.frames.size() == 4);
  CHECK(set.frames[3].stamp_ns == 300'000'000);
  CHECK_THAT(set.frames[2].right, Contains("image_1/000002.png"));
  CHECK(set.rig.left.fx == 100);
  CHECK(set.rig.left.cy == 11);
  CHECK(set.rig.left.width == 32);
  CHECK(set.rig.right_from_left.translation().isApprox(Eigen::Vector3d(-0.5, 0, 0)));
  REQUIRE(set.truth.size() == 4);
  CHECK(set.truth[3].world_from_left.translation().z() == 3);
  CHECK(set.truth[3].stamp_ns == set.frames[3].stamp_ns);
  CHECK(open_dataset(folder.path()).frames.size() == 4);
  DatasetOptions options;
  options.sequence = "07";
  options.first_frame = 1;
  options.last_frame = 3;
  const Dataset part = open_dataset(folder.path(), options);
  REQUIRE(part.frames.size() == 2);
  CHECK(part.frames[0].stamp_ns == 100'000'000);
  options.last_frame = 5;
  CHECK_THROWS_AS(open_dataset(folder.path(), options), UsageError);
}

TEST_CASE("dataset: several KITTI sequences require a name") {
  const TemporaryFolder folder;
  write_kitti(folder.path());
  write_image(folder / "sequences/08/image_0/000000.png");
  CHECK_THROWS_WITH(open_dataset(folder.path()), Contains("07, 08") && Contains("sequences/07"));
  DatasetOptions options;
  options.sequence = "09";
  CHECK_THROWS_WITH(open_dataset(folder.path(), options), Contains("\"09\"") && Contains("07, 08"));
  options.sequence = "07";
  CHECK(open_dataset(folder.path(), options).name == "kitti_07");
}

TEST_CASE("dataset: KITTI colour cameras have their own calibration and transformed ground truth") {
  const TemporaryFolder folder;
  const Dataset set = open_dataset(write_kitti(folder.path(), 3, "image_2", "image_3"));
  // P2 = K [I | t2], t2 = K^-1 (6, -1, 0.01): x = (6 - 15 * 0.01) / 100, y = (-1 - 11 * 0.01) / 100.
  const Eigen::Vector3d t2(0.0585, -0.0111, 0.01), t3((-44 - 0.15) / 100, (2 - 0.11) / 100, 0.01);
  CHECK(set.rig.right_from_left.translation().isApprox(t3 - t2, 1e-12));
  // The left camera's centre lies at -t2 in camera 0, whose pose the file holds.
  CHECK(set.truth[2].world_from_left.translation().isApprox(Eigen::Vector3d(0, 0, 2) - t2, 1e-12));
}

TEST_CASE("dataset: KITTI images keep their numbers in an excerpt") {
  const TemporaryFolder folder;
  const std::string sequence = write_kitti(folder.path());
  for (const char* side : {"/image_0", "/image_1"}) std::filesystem::remove(sequence + side + "/000000.png");
  const Dataset set = open_dataset(sequence);
  REQUIRE(set.frames.size() == 3);
  CHECK(set.frames[0].stamp_ns == 100'000'000);
  CHECK(set.truth[0].world_from_left.translation().z() == 1);
}

TEST_CASE("dataset: EuRoC gives pinhole cameras, undistortion and the left camera's ground truth") {
  const TemporaryFolder folder;
  const Dataset set = open_dataset(write_euroc(folder.path()));
  CHECK(set.format == "euroc");
  REQUIRE(set.frames.size() == 4);
  CHECK(set.frames[1].stamp_ns == 1403715273362143104);
  CHECK(set.rig.left.fy == 31);
  CHECK(set.rig.left.height == 24);
  // Both x axes are the body's y axis; the right camera is 0.11 m farther along it.
  CHECK(set.rig.right_from_left.translation().isApprox(Eigen::Vector3d(-0.11, 0, 0), 1e-9));
  REQUIRE(set.truth.size() == 4);
  CHECK(set.truth[2].world_from_left.translation().isApprox(Eigen::Vector3d(2, 2.25, 3), 1e-9));
  CHECK((set.truth[2].world_from_left.linear() * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-9));
  CHECK(set.truth[2].stamp_ns == set.frames[2].stamp_ns);
  // Radial model at one pixel, by hand: x' = (x - cx) / fx, r2 = x'^2 + y'^2, factor 1 + k1 r2 + k2 r2^2.
  const auto& table = set.rig.left_undistortion;
  REQUIRE(table.source_x.size() == 32u * 24u);
  const double x = (3 - 15.5) / 30, y = (20 - 11.25) / 31, r2 = x * x + y * y, factor = 1 - 0.28 * r2 + 0.07 * r2 * r2;
  CHECK(table.source_x[20 * 32 + 3] == Approx(30 * x * factor + 15.5).epsilon(1e-6));
  CHECK(table.source_y[20 * 32 + 3] == Approx(31 * y * factor + 11.25).epsilon(1e-6));
  CHECK(open_dataset(folder / "mav0").frames.size() == 4);
}

TEST_CASE("dataset: a sensor.yaml may have OpenCV's first line, tags and dash lists") {
  const TemporaryFolder folder;
  const std::string root = write_euroc(folder.path()), yaml = root + "/mav0/cam0/sensor.yaml";
  const Dataset plain = open_dataset(root);
  std::string text = read_text(yaml);
  text.replace(text.find("T_BS:"), 5, "T_BS: !!opencv-matrix");
  text.replace(text.find("[32, 24]"), 8, "\n  - 32\n  - 24");
  write_text(yaml, "%YAML:1.0\n---\n" + text);
  const Dataset set = open_dataset(root);
  CHECK(set.rig.left.matrix() == plain.rig.left.matrix());
  CHECK(set.rig.left.height == 24);
  CHECK(set.rig.right_from_left.matrix() == plain.rig.right_from_left.matrix());
}

TEST_CASE("dataset: EuRoC images are paired by timestamp, and unpaired ones are reported") {
  const TemporaryFolder folder;
  write_euroc(folder.path());
  const std::string list = folder / "mav0/cam1/data.csv";
  std::string text = read_text(list);
  text.erase(text.find("1403715273362143104,"), text.find("1403715273412143104,") - text.find("1403715273362143104,"));
  write_text(list, text);
  const Dataset set = open_dataset(folder.path());
  REQUIRE(set.frames.size() == 3);
  CHECK(set.frames[1].stamp_ns == 1403715273412143104);
  CHECK_THAT(set.frames[1].right, Contains("cam1/data/1403715273412143104.png"));
  REQUIRE(set.notes.size() == 1);
  CHECK_THAT(set.notes[0], Contains("1 left and 0 right"));
}

TEST_CASE("dataset: in ETH3D SLAM the camera on the left becomes the left one") {
  const TemporaryFolder folder;
  write_eth3d_slam(folder.path());
  write_text(folder / "depth/ignored.pfm", "");
  const Dataset published = open_dataset(folder.path());
  CHECK(published.format == "eth3d-slam");
  REQUIRE(published.frames.size() == 4);
  CHECK(published.frames[1].stamp_ns == 12'125'000'001);
  CHECK_THAT(published.frames[0].left, Contains("rgb2/"));
  CHECK(published.rig.left.fx == 42);
  CHECK(published.rig.left.height == 26);
  CHECK(published.rig.right.width == 32);
  CHECK(published.rig.right_from_left.translation().isApprox(Eigen::Vector3d(-0.09, 0, 0.001)));
  // The ground truth is camera 1's, with identity rotation; the left camera is 0.09 m to its left: x smaller by 0.09.
  CHECK(published.truth[2].world_from_left.translation().isApprox(Eigen::Vector3d(2 - 0.09, 0, 0.001), 1e-12));

  write_text(folder / "extrinsics_1_2.txt", "1 0 0 0.09\n0 1 0 0\n0 0 1 0\n");
  const Dataset mirrored = open_dataset(folder.path());
  CHECK_THAT(mirrored.frames[0].left, Contains("rgb/"));
  CHECK(mirrored.rig.left.fx == 40);
  CHECK(mirrored.truth[2].world_from_left.translation().isApprox(Eigen::Vector3d(2, 0, 0), 1e-12));
  // In either case the right camera must see a point in front of the rig farther left.
  for (const auto& set : {published, mirrored}) {
    const Eigen::Vector3d point(0.1, 0.05, 2), in_right = set.rig.right_from_left * point;
    CHECK((point / point.z()).x() > (in_right / in_right.z()).x());
  }
  std::filesystem::remove(folder / "rgb.txt");
  CHECK(open_dataset(folder.path()).frames[1].stamp_ns == 12'125'000'001);
}

TEST_CASE("dataset: still pairs and the quad are recognised by file names") {
  const TemporaryFolder folder;
  write_image(folder / "a/two_view_training/s/im0.png", 710, 40, CV_8UC3);
  write_image(folder / "a/two_view_training/s/im1.png", 710, 40, CV_8UC3);
  const Dataset nominal = open_dataset(folder / "a/two_view_training/s");
  CHECK(nominal.format == "eth3d-two-view");
  CHECK(nominal.rig.baseline() == Approx(0.06));
  REQUIRE(nominal.notes.size() == 1);
  CHECK_THAT(nominal.notes[0], Contains("nominal"));
  const std::string calibration =
      "cam0=[50 0 20; 0 51 15; 0 0 1]\ncam1=[50 0 23.5; 0 51 15; 0 0 1]\ndoffs=3.5\nbaseline=60\n"
      "width=710\nheight=40\nndisp=64\n";
  write_text(folder / "a/two_view_training/s/calib.txt", calibration);
  write_text(folder / "a/two_view_training_gt/s/disp0GT.pfm", "Pf");
  const Dataset calibrated = open_dataset(folder / "a/two_view_training/s/");
  CHECK(calibrated.format == "eth3d-two-view");
  CHECK(calibrated.rig.left.fy == 51);
  CHECK(calibrated.notes.empty());
  CHECK_THAT(calibrated.disparity_truth, Contains("two_view_training_gt/s/disp0GT.pfm"));

  for (const char* name : {"m14/im0.png", "m14/im1.png"}) write_image(folder / name, 710, 40);
  write_text(folder / "m14/calib.txt", calibration);
  const Dataset middlebury = open_dataset(folder / "m14");
  CHECK(middlebury.format == "middlebury-2014");
  CHECK(middlebury.rig.right.cx == 23.5);
  CHECK(middlebury.rig.baseline() == Approx(0.06));
  CHECK(middlebury.rig.max_disparity == Approx(67.5));

  for (const char* name : {"Art/view1.png", "Art/view5.png", "Aloe/view1.png", "Aloe/view5.png"})
    write_image(folder / name, 463, 370);
  write_text(folder / "Art/dmin.txt", "200\r\n");
  const Dataset art = open_dataset(folder / "Art");
  CHECK(art.format == "middlebury-2005");
  CHECK(art.rig.left.fx == Approx(3740.0 / 3));
  // Z = 3740 x 0.16 / (d + dmin) in full-size pixels: a disparity of 100 full-size pixels is 33.3 pixels here.
  const double depth = art.rig.left.fx * art.rig.baseline() / (100.0 / 3 + art.rig.right.cx - art.rig.left.cx);
  CHECK(depth == Approx(3740 * 0.16 / 300));
  CHECK(open_dataset(folder / "Aloe").format == "middlebury-2005");
  for (const char* name : {"t/im2.png", "t/im6.png"}) write_image(folder / name, 450, 375);
  CHECK(open_dataset(folder / "t").format == "middlebury-2003");
  for (const char* name : {"q/I1p.png", "q/I2p.png", "q/I1c.png", "q/I2c.png"}) write_image(folder / name, 64, 40);
  const Dataset quad = open_dataset(folder / "q");
  CHECK(quad.format == "viso2-quad");
  REQUIRE(quad.frames.size() == 2);
  CHECK_THAT(quad.frames[0].left, Contains("I1p"));
  CHECK_THAT(quad.frames[1].right, Contains("I2c"));
  DatasetOptions options;
  options.format = "kitti";
  CHECK_THROWS_AS(open_dataset(folder / "q", options), DataError);
  options.format = "mp4";
  CHECK_THROWS_WITH(open_dataset(folder / "q", options), Contains("mp4") && Contains("eth3d-two-view"));
}

TEST_CASE("dataset: the third Middlebury benchmark has spaces around keys and the ground truth beside the images") {
  const TemporaryFolder folder;
  for (const char* name : {"v3/im0.png", "v3/im1.png"}) write_image(folder / name, 710, 40);
  write_text(folder / "v3/calib.txt",
             "cam0=[ 50 0 20; 0 51 15; 0 0 1 ] \n cam1=[50 0 23.5; 0 51 15; 0 0 1]\n doffs= 3.5\nbaseline= 60 \n"
             " width= 710 \n height= 40\nndisp= 190\n");
  write_text(folder / "v3/disp0GT.pfm", "Pf");
  const Dataset benchmark = open_dataset(folder / "v3");
  CHECK_THAT(benchmark.disparity_truth, Contains("v3/disp0GT.pfm"));
  CHECK(benchmark.rig.right.cx == 23.5);
  CHECK(benchmark.rig.max_disparity == Approx(193.5));
}

TEST_CASE("dataset: ETH3D's many-view scenes are sequences of stereo_pairs") {
  const TemporaryFolder folder;
  const std::string calibration =
      "cam0=[50 0 15.5; 0 50 11.5; 0 0 1]\ncam1=[50 0 15.5; 0 50 11.5; 0 0 1]\ndoffs=0\nbaseline=60\nwidth=32\n"
      "height=24\nndisp=32\n";
  const std::string pairs = folder / "delivery/stereo_pairs";
  // A camera that moves by 0.1 m along x, looking along z: camera_from_world has the translation -0.1 i. The last one
  // is turned by 90 degrees about y, which maps the world's z to the camera's x.
  const char* rows[] = {"7 1 0 0 0 0 0 0 0 im0.png", "9 1 0 0 0 -0.1 0 0 0 im0.png",
                        "11 0.70710678118654757 0 0.70710678118654757 0 0 0 0.2 0 im0.png"};
  for (int i = 0; i < 3; ++i) {
    const std::string pair = pairs + "/" + std::to_string(1477843917481127523 + 100'000'000LL * i);
    for (const char* name : {"/im0.png", "/im1.png"}) write_image(pair + name);
    write_text(pair + "/calib.txt", calibration);
    write_text(pair + "/images.txt",
               "# IMAGE_ID, QW ...\n6 1 0 0 0 9 9 9 1 im1.png\n1 2 3\n" + std::string(rows[i]) + "\n\n");
    if (i == 0) write_text(pair + "/disp0GT.pfm", "Pf");
  }
  for (const std::string& path : {folder / "delivery", pairs}) {
    const Dataset set = open_dataset(path);
    CHECK(set.format == "eth3d-stereo-pairs");
    CHECK(set.name == "delivery");
    REQUIRE(set.frames.size() == 3);
    CHECK(set.frames[1].stamp_ns == 1477843917581127523);
    CHECK_THAT(set.frames[1].right, Contains("1477843917581127523/im1.png"));
    CHECK(set.rig.baseline() == Approx(0.06));
    CHECK(set.rig.max_disparity == 64);  // ndisp is the width, which says nothing
    REQUIRE(set.truth.size() == 3);
    CHECK(set.truth[1].world_from_left.translation().isApprox(Eigen::Vector3d(0.1, 0, 0)));
    CHECK(set.truth[2].world_from_left.translation().isApprox(Eigen::Vector3d(0.2, 0, 0)));
    CHECK((set.truth[2].world_from_left.linear() * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitZ()));
    CHECK_THAT(set.disparity_truth, Contains("1477843917481127523/disp0GT.pfm"));
  }
  write_text(pairs + "/1477843917681127523/images.txt", "6 1 0 0 0 9 9 9 1 im1.png\n");
  CHECK_THROWS_WITH(open_dataset(pairs), Contains("1477843917681127523/images.txt") && Contains("no row of im0.png"));
  std::filesystem::remove(pairs + "/1477843917681127523/images.txt");
  CHECK(open_dataset(pairs).truth.size() == 2);
  std::string other = calibration;
  write_text(pairs + "/1477843917681127523/calib.txt", other.replace(other.find("60"), 2, "61"));
  CHECK_THROWS_WITH(open_dataset(pairs), Contains("1477843917681127523/calib.txt") && Contains("another calibration"));
  for (const auto& entry : std::filesystem::directory_iterator(pairs))
    std::filesystem::remove(entry.path() / "calib.txt");
  CHECK_THROWS_WITH(open_dataset(pairs), Contains("1477843917481127523/calib.txt"));
  write_text(folder / "delivery/calib.txt", calibration);
  CHECK(open_dataset(pairs).rig.left.fx == 50);
  std::filesystem::remove(pairs + "/1477843917581127523/im1.png");
  CHECK_THROWS_WITH(open_dataset(pairs), Contains("1477843917581127523/im1.png"));
}
