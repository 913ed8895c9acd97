#include "data/sequence_writer.hpp"
#include "dataset_files.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;

TEST_CASE("dataset: a rendered sequence is written with its stamps, its depths, and not over another") {
  const TemporaryFolder folder;
  const SyntheticSequence sequence(rendering(80, 60, 60, 3, 1));
  int calls = 0;
  write_eth3d_slam(folder / "s", sequence, [&](int done, int all) {
    CHECK(done == ++calls);
    CHECK(all == 3);
  });
  CHECK(calls == 3);
  const Dataset set = open_dataset(folder / "s");
  CHECK(set.format == "eth3d-slam");
  CHECK(check_dataset(folder / "s").errors.empty());
  REQUIRE(set.frames.size() == 3);
  for (int i = 0; i < 3; ++i) {
    const auto& files = set.frames[static_cast<std::size_t>(i)];
    CHECK(files.stamp_ns == sequence.stamp_ns(i));
    const RenderedView right = sequence.render(i, Side::right);
    std::string depth = files.right;
    depth.replace(depth.find("/rgb2/"), 6, "/depth2/").replace(depth.size() - 3, 3, "pfm");
    const cv::Mat map = cv::imread(depth, cv::IMREAD_UNCHANGED);
    CHECK(map.cols == 80);
    CHECK(std::vector<float>(map.begin<float>(), map.end<float>()) == right.depth);
  }
  CHECK_THROWS_WITH(write_eth3d_slam(folder / "s", sequence), Contains("existing sequence"));
  write_text(folder / "file", "");
  CHECK_THROWS_AS(write_eth3d_slam(folder / "file/s", sequence), DataError);
}

TEST_CASE("dataset: the cameras of ETH3D's SLAM benchmark are rendered and read back") {
  const TemporaryFolder folder;
  SyntheticOptions options;
  options.rig = "eth3d-slam";
  options.scene = "cables";
  options.frames = 2;
  options.supersampling = 1;
  const SyntheticSequence sequence(options);
  write_eth3d_slam(folder / "s", sequence);
  CHECK(check_dataset(folder / "s").errors.empty());
  const Dataset set = open_dataset(folder / "s");
  REQUIRE(set.frames.size() == 2);
  // The left camera is rgb2/, as published: 742 x 464, its axis 76 px lower in the image than the right one's.
  CHECK_THAT(set.frames[0].left, Contains("/rgb2/"));
  CHECK(set.rig.left.width == 742);
  CHECK(set.rig.right.height == 458);
  CHECK(set.rig.left.cy - set.rig.right.cy == Approx(262.196411 - 186.465668));
  CHECK(set.rig.right.fx == 726.287415);
  CHECK(set.rig.baseline() == Approx(0.0898319).epsilon(1e-5));
  CHECK((set.rig.right_from_left.matrix() - sequence.rig().right_from_left.matrix()).cwiseAbs().maxCoeff() < 1e-9);
  // groundtruth.txt is of camera 1, the right one, and is converted to the left camera.
  const Trajectory written = read_tum(folder / "s/groundtruth.txt");
  const Eigen::Isometry3d right = sequence.world_from_left(1) * sequence.rig().right_from_left.inverse();
  CHECK((written[1].world_from_left.matrix() - right.matrix()).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((set.truth[1].world_from_left.matrix() - sequence.world_from_left(1).matrix()).cwiseAbs().maxCoeff() < 1e-9);
  // A point of the left view, by its depth, lies at the same depth in the right view.
  const RenderedView left = sequence.render(0, Side::left), far = sequence.render(0, Side::right);
  const Eigen::Vector2d pixel(371, 232);
  const float depth = left.depth[232 * 742 + 371];
  const Eigen::Vector3d point = sequence.rig().right_from_left * (set.rig.left.ray(pixel) * depth);
  const Eigen::Vector2d seen = set.rig.right.project(point);
  const auto index =
      static_cast<std::size_t>(std::lround(seen.y())) * 739 + static_cast<std::size_t>(std::lround(seen.x()));
  CHECK(far.depth[index] == Approx(point.z()).epsilon(0.02));
  options.rig = "other";
  CHECK_THROWS_WITH(SyntheticSequence(options), Contains("other") && Contains("eth3d-slam"));
}
