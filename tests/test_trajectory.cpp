#include "dataset_files.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

Trajectory winding(int count) {
  Trajectory trajectory;
  for (int i = 0; i < count; ++i) {
    StampedPose pose;
    pose.stamp_ns = 1403715273312143104 + 49'999'872LL * i;
    pose.world_from_left = Eigen::Translation3d(0.1 * i, 1.0 / 3 * i, -0.07 * i * i) *
                           Eigen::AngleAxisd(0.4 * i, Eigen::Vector3d(1, 2, -0.5).normalized());
    trajectory.push_back(pose);
  }
  return trajectory;
}

}  // namespace

TEST_CASE("trajectory: a TUM file keeps timestamps to the nanosecond and poses up to rounding") {
  const TemporaryFolder folder;
  const Trajectory written = winding(12);
  write_tum(folder / "t.txt", written);
  CHECK_THAT(read_text(folder / "t.txt"),
             Contains("\n1403715273.312143104 0 0 -0 0 0 0 1\n") || Contains("\n1403715273.312143104 0 0 0 0 0 0 1\n"));
  const Trajectory read = read_tum(folder / "t.txt");
  REQUIRE(read.size() == written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    CHECK(read[i].stamp_ns == written[i].stamp_ns);
    CHECK((read[i].world_from_left.matrix() - written[i].world_from_left.matrix()).cwiseAbs().maxCoeff() < 1e-14);
  }
}

TEST_CASE("trajectory: a TUM file keeps the segments in comments") {
  const TemporaryFolder folder;
  Trajectory written = winding(6);
  for (std::size_t i = 2; i < 6; ++i) written[i].segment = i < 5 ? 1 : 4;
  write_tum(folder / "t.txt", written);
  const Trajectory read = read_tum(folder / "t.txt");
  REQUIRE(read.size() == 6);
  for (std::size_t i = 0; i < 6; ++i) CHECK(read[i].segment == written[i].segment);

  const std::string pose = " 0 0 0 0 0 0 1\n";
  const auto segments = [&](const std::string& comment) {
    write_text(folder / "c.txt", "1" + pose + comment + "\r\n2" + pose);
    return read_tum(folder / "c.txt")[1].segment;
  };
  CHECK(segments("# segment 3") == 3);
  CHECK(segments("# segment 3: other words") == 3);
  for (const char* other : {"# segments 3", "#segment 3", "# segment", "# segment x", "# segment 3b", "# segment -1"})
    CHECK(segments(other) == 0);
  write_text(folder / "c.txt", "1" + pose + "# segment 2\n2" + pose + "# segment 2\n3" + pose);
  CHECK_THROWS_WITH(read_tum(folder / "c.txt"), Contains("c.txt:4: found segment 2 after segment 2"));
}

TEST_CASE("trajectory: a KITTI file keeps the matrices") {
  const TemporaryFolder folder;
  const Trajectory written = winding(5);
  write_kitti(folder / "k.txt", written);
  const Trajectory rows = read_kitti(folder / "k.txt");
  REQUIRE(rows.size() == 5);
  CHECK(rows[3].stamp_ns == 3);
  CHECK(rows[3].world_from_left.matrix() == written[3].world_from_left.matrix());
  const Trajectory stamped = read_kitti(folder / "k.txt", {5, 6, 7, 8, 100});
  CHECK(stamped[4].stamp_ns == 100);
  CHECK_THROWS_WITH(read_kitti(folder / "k.txt", {5, 6}), Contains("5 poses") && Contains("2"));
}

TEST_CASE("trajectory: timestamps are decimal numbers, not doubles") {
  const TemporaryFolder folder;
  write_text(folder / "t.txt",
             "# comment\r\n-1.5 0 0 0 0 0 0 1\r\n0.0000000014 0 0 0 0 0 0 1\n0.0000000015 0 0 0 0 0 0 1\n"
             "1.037e-01 0 0 0 0 0 0 1\n9 0 0 0 0 0 0 -1\n1403715273.312143104 1 2 3 0 0 0 1\n");
  const Trajectory read = read_tum(folder / "t.txt");
  REQUIRE(read.size() == 6);
  CHECK(read[0].stamp_ns == -1'500'000'000);
  CHECK(read[1].stamp_ns == 1);
  CHECK(read[2].stamp_ns == 2);
  CHECK(read[3].stamp_ns == 103'700'000);
  CHECK(read[4].world_from_left.isApprox(Eigen::Isometry3d::Identity()));
  CHECK(read[5].stamp_ns == 1403715273312143104);
  write_tum(folder / "n.txt", {{-1, Eigen::Isometry3d::Identity()}});
  CHECK_THAT(read_text(folder / "n.txt"), Contains("\n-0.000000001 0"));
}

TEST_CASE("trajectory: the file format follows from the number of columns") {
  const TemporaryFolder folder;
  write_tum(folder / "t.txt", winding(3));
  write_kitti(folder / "k.txt", winding(3));
  CHECK(read_trajectory(folder / "t.txt")[2].stamp_ns > 1'000'000'000);
  CHECK(read_trajectory(folder / "k.txt")[2].stamp_ns == 2);
  write_text(folder / "b.txt", "1 2 3\n");
  CHECK_THROWS_WITH(read_trajectory(folder / "b.txt"),
                    Contains("b.txt:1") && Contains("3 columns") && Contains("8 (TUM)"));
  write_text(folder / "b.txt", "# nothing\n");
  CHECK_THROWS_WITH(read_trajectory(folder / "b.txt"), Contains("no pose"));
}

TEST_CASE("trajectory: errors about bad rows name the file and the line") {
  const TemporaryFolder folder;
  const std::string good = "1 0 0 0 0 0 0 1\n", file = folder / "t.txt";
  const auto fault = [&](const std::string& row, const std::string& found) {
    write_text(file, good + row + "\n");
    CHECK_THROWS_AS(read_tum(file), DataError);
    CHECK_THROWS_WITH(read_tum(file), StartsWith(file + ":2") && Contains(found) && Contains("expected"));
  };
  fault("2 0 0 0 0 0 0", "7 columns");
  fault("2 0 nan 0 0 0 0 1", "\"nan\"");
  fault("2 0 0,5 0 0 0 0 1", "\"0,5\"");
  fault("2 0 0 0 0 0 0 0", "length 0.0");
  fault("1 0 0 0 0 0 0 1", "1.000000000 after 1.000000000");
  fault("1e30 0 0 0 0 0 0 1", "\"1e30\"");
  write_text(file, "1 0 0 0 0 1 0 0 0 0 1 0\n2 0 0 0 0 1 0 0 0 0 1 0\n");
  CHECK_THROWS_WITH(read_kitti(file), StartsWith(file + ":2") && Contains("not a rotation"));
}

TEST_CASE("trajectory: a failed write is an error and leaves the old file unchanged") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(write_tum(folder / "absent/t.txt", winding(2)),
                    Contains("absent/t.txt") && Contains("No such file"));
  if (std::filesystem::exists("/dev/full")) {
    CHECK_THROWS_AS(write_tum("/dev/full", winding(2)), DataError);
    CHECK_THROWS_WITH(write_kitti("/dev/full", winding(2)), Contains("/dev/full") && Contains("No space left"));
    CHECK(std::filesystem::is_character_file("/dev/full"));
  } else {
    WARN("SKIPPED: no /dev/full here");
  }
  write_tum(folder / "t.txt", winding(2));
  write_tum(folder / "t.txt", winding(3));
  CHECK(read_tum(folder / "t.txt").size() == 3);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), std::filesystem::directory_iterator()) == 1);
  std::filesystem::create_directory(folder / "taken");
  CHECK_THROWS_AS(write_tum(folder / "taken", winding(2)), DataError);
}

TEST_CASE("trajectory: CSV files of EuRoC, TUM-VI and VINS-Fusion, and ORB-SLAM3's nanoseconds") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& text) {
    std::ofstream(folder / "file") << text;
    return read_trajectory(folder / "file");
  };
  const std::string rows[] = {
      "#timestamp [ns], p_RS_R_x [m], ...\n1403636584763555584,1,2,3,0.6,0,0.8,0\n",
      "1403636584763555584,1,2,3,0.6,0,0.8,0,0.1,0.2,0.3,\n",
      "1403636584763555584.000000 1 2 3 0 0.8 0 0.6\n",
      "1403636584.763555584 1 2 3 0 0.8 0 0.6\n",
  };
  for (const std::string& text : rows) {
    INFO(text);
    const Trajectory poses = read(text);
    REQUIRE(poses.size() == 1);
    CHECK(poses[0].stamp_ns == 1403636584763555584);
    CHECK(poses[0].world_from_left.translation() == Eigen::Vector3d(1, 2, 3));
    CHECK(poses[0].world_from_left.linear()(0, 2) == Approx(2 * 0.8 * 0.6));  // a turn about y with w = 0.6
  }
  CHECK_THROWS_WITH(read("7,1,2,3,0.6,0,0.8,0\n6,1,2,3,0.6,0,0.8,0\n"), Contains("file:2") && Contains("6 after 7"));
}
