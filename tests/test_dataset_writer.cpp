#include <catch2/catch.hpp>
#include <cmath>

#include "data/float_map.hpp"
#include "data/sequence_writer.hpp"
#include "dataset_files.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/error.hpp"
#include "temporary_folder.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;

TEST_CASE("dataset: a rendered sequence is read back as it was written", "[dataset]") {
  const TemporaryFolder folder;
  SyntheticOptions options;
  options.frames = 3;
  options.width = 80;
  options.height = 60;
  options.focal = 60;
  options.supersampling = 1;
  const SyntheticSequence sequence(options);
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
  CHECK(set.rig.left.matrix() == sequence.rig().left.matrix());
  CHECK(set.rig.right.matrix() == sequence.rig().right.matrix());
  CHECK((set.rig.right_from_left.matrix() - sequence.rig().right_from_left.matrix()).cwiseAbs().maxCoeff() < 1e-15);
  REQUIRE(set.truth.size() == 3);
  for (int i = 0; i < 3; ++i) {
    const auto& files = set.frames[static_cast<std::size_t>(i)];
    CHECK(files.stamp_ns == sequence.stamp_ns(i));
    CHECK((set.truth[static_cast<std::size_t>(i)].world_from_left.matrix() - sequence.world_from_left(i).matrix())
              .cwiseAbs()
              .maxCoeff() < 1e-14);
    const RenderedView left = sequence.render(i, Side::left), right = sequence.render(i, Side::right);
    CHECK(read_grey_image(files.left).pixels == left.image.pixels);
    CHECK(read_grey_image(files.right).pixels == right.image.pixels);
    std::string depth = files.right;
    depth.replace(depth.find("/rgb2/"), 6, "/depth2/").replace(depth.size() - 3, 3, "pfm");
    const data::FloatMap map = data::read_float_map(depth);
    CHECK(map.width == 80);
    CHECK(map.values == right.depth);
  }
  CHECK_THROWS_WITH(write_eth3d_slam(folder / "s", sequence), Contains("existing sequence"));
  dataset_files::write_text(folder / "file", "");
  CHECK_THROWS_AS(write_eth3d_slam(folder / "file/s", sequence), DataError);
}

TEST_CASE("dataset: a PFM is read bottom row first, in both byte orders, with unscaled values", "[dataset]") {
  const TemporaryFolder folder;
  const std::string file = folder / "m.pfm";
  using namespace std::string_literals;
  const std::string pixels = "\0\0\x80\x3f\0\0\0\x40\0\0\x40\x40\0\0\x80\x7f"s;
  for (const char* scale : {"-1", "-1.0", "-0.00390625"}) {
    INFO(scale);
    dataset_files::write_text(file, "Pf\n2 2\n"s + scale + "\n" + pixels);
    CHECK(data::read_float_map(file).values == std::vector<float>{3, std::numeric_limits<float>::infinity(), 1, 2});
  }
  dataset_files::write_text(file, "Pf\n1 1\n1.0\n\x40\x40\0\0"s);
  CHECK(data::read_float_map(file).values[0] == 3);
}

TEST_CASE("dataset: truncated, colour and invalid PFM files are refused by name", "[dataset]") {
  const TemporaryFolder folder;
  const std::string file = folder / "m.pfm";
  using namespace std::string_literals;
  const auto refused = [&](const std::string& bytes, const std::string& found, const std::string& expected) {
    INFO(bytes);
    dataset_files::write_text(file, bytes);
    CHECK_THROWS_AS(data::read_float_map(file), DataError);
    CHECK_THROWS_WITH(data::read_float_map(file), Contains("m.pfm") && Contains(found) && Contains(expected));
  };
  refused("Pf\n2 2\n-1\n\0\0\x80\x3f"s, "found 14 bytes", "2 x 2 floats");
  refused("Pf\n2 2\n-1\n\0\0\x80\x3f\0\0\x80\x3f\0\0\x80\x3f"s, "found 22 bytes", "2 x 2 floats");
  refused("PF\n1 1\n-1\n\0\0\x80\x3f\0\0\x80\x3f\0\0\x80\x3f"s, "\"PF?1 1?-\"", "\"Pf\"");
  refused("Pf\n2", "\"Pf?2\"", "width, height and scale");
  refused("", "an empty file", "\"Pf\"");
  refused("Pf\n1 two\n-1\n\0\0\0\0"s, "\"two\"", "height");
  refused("Pf\n1 1\nleft\n\0\0\0\0"s, "\"left\"", "scale");
  refused("Pf\n-1 1\n-1\n\0\0\0\0"s, "cannot be decoded", "width");
  refused("Pf\n99999 99999\n-1\n\0\0\0\0"s, "bytes", "99999 x 99999");
  std::filesystem::remove(file);
  CHECK_THROWS_WITH(data::read_float_map(file), Contains("m.pfm") && Contains("readable file"));
}

TEST_CASE("dataset: the cameras of ETH3D's SLAM benchmark are rendered and read back", "[dataset]") {
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
