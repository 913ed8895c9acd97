#include "common/images.hpp"
#include "dataset_files.hpp"
#include "program.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;

namespace {

constexpr int kFrames = 8;

SyntheticOptions scene(double mover, const std::string& lens = "pinhole") {
  auto options = rendering(320, 200, 184, kFrames, 4);
  options.mover = mover;
  options.lens = lens;
  return options;
}

/// A room in which somebody walks through half of the view, with masks of the walker in both images.
struct Walk {
  explicit Walk(const std::string& lens = "pinhole") : walked(scene(0.5, lens)) {
    const SyntheticSequence empty(scene(0, lens));
    for (int i = 0; i < kFrames; ++i) {
      StereoPair& pair = pairs.emplace_back(walked.pair(i));
      for (const Side side : kSides) {
        const RenderedView with = walked.render(i, side), without = empty.render(i, side);
        Image& mask = side == Side::left ? pair.left_mask : pair.right_mask;
        mask = Image(with.image.width, with.image.height);
        for (std::size_t pixel = 0; pixel < with.depth.size(); ++pixel) {
          mask.pixels[pixel] = with.depth[pixel] == without.depth[pixel] ? 255 : 0;
          hidden += mask.pixels[pixel] == 0 ? 1 : 0;
        }
      }
    }
    hidden /= 2.0 * kFrames * static_cast<double>(pairs.front().left.pixel_count());
  }

  SyntheticSequence walked;
  std::vector<StereoPair> pairs;
  double hidden = 0;  ///< part of the images
};

const Walk& walk() {
  static const Walk walk;
  return walk;
}

enum class Masks { none, white, of_walker };

std::vector<FrameResult> track(const Walk& walk, const std::string& device_name, Masks masks) {
  Device device(device_name, kept_programs());
  StereoOdometry odometry(walk.walked.rig(), device);
  std::vector<FrameResult> results;
  for (const StereoPair& pair : walk.pairs) {
    StereoFrame frame = pair.view();
    Image white(pair.left.width, pair.left.height);
    std::fill(white.pixels.begin(), white.pixels.end(), std::uint8_t{1});
    if (masks == Masks::none) frame.left_mask = frame.right_mask = {};
    if (masks == Masks::white) frame.left_mask = frame.right_mask = white.view();
    results.push_back(odometry.track(frame));
    if (masks != Masks::of_walker) continue;
    const FrameDetails details = odometry.details();
    for (const EdgeSet* edges : {&details.left_edges, &details.right_edges})
      for (std::size_t i = 0; i < edges->size(); ++i) {
        const Image& mask = edges == &details.left_edges ? pair.left_mask : pair.right_mask;
        if (!walk.walked.rig().left_undistortion.empty()) break;  // the mask is of the recorded image
        const auto x = static_cast<int>(std::lround(edges->x[i])), y = static_cast<int>(std::lround(edges->y[i]));
        REQUIRE(mask.view().value(x, y) != 0);
      }
  }
  return results;
}

/// Largest error of the poses [m]; a frame that is lost, or says that it may be wrong, has none.
double worst(const Walk& walk, const std::vector<FrameResult>& results, int& stated) {
  double error = 0;
  stated = 0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!results[i].world_from_left || results[i].ambiguous_motion) continue;
    ++stated;
    const Eigen::Isometry3d truth = walk.walked.world_from_left(static_cast<int>(i));
    error = std::max(error, (results[i].world_from_left->translation() - truth.translation()).norm());
  }
  return error;
}

}  // namespace

TEST_CASE("frame masks: with a walker in half of the view masked, every pose is right", "[device]") {
  REQUIRE(walk().hidden > 0.4);
  for (const auto& name : all_devices()) {
    INFO(name);
    int stated = 0;
    CHECK(worst(walk(), track(walk(), name, Masks::of_walker), stated) < 0.004);
    CHECK(stated == kFrames);
  }
  // Without masks nothing wrong is stated as right.
  int stated = 0;
  CHECK(worst(walk(), track(walk(), all_devices().front(), Masks::none), stated) < 0.02);
}

TEST_CASE("frame masks: they refer to the recorded image of a lens", "[device]") {
  const Walk distorted("radtan");
  int stated = 0;
  CHECK(worst(distorted, track(distorted, all_devices().front(), Masks::of_walker), stated) < 0.006);
  CHECK(stated == kFrames);
}

TEST_CASE("frame masks: masks that hide nothing change nothing, and the reference masks the same", "[device]") {
  const auto none = track(walk(), all_devices().front(), Masks::none),
             white = track(walk(), all_devices().front(), Masks::white);
  for (std::size_t i = 0; i < none.size(); ++i) {
    CHECK(none[i].pose_or_prediction().matrix() == white[i].pose_or_prediction().matrix());
    CHECK(none[i].counts.stereo_edges == white[i].counts.stereo_edges);
  }
  const auto masked = track(walk(), all_devices().front(), Masks::of_walker),
             reference = track(walk(), "reference", Masks::of_walker);
  for (std::size_t i = 0; i < masked.size(); ++i) {
    CHECK(masked[i].counts.edges_left == Approx(reference[i].counts.edges_left).epsilon(0.02));
    CHECK(masked[i].counts.edges_right == Approx(reference[i].counts.edges_right).epsilon(0.02));
    CHECK(masked[i].counts.edges_left < 0.8 * none[i].counts.edges_left);
  }
}

TEST_CASE("frame masks: one of another size or depth is an error, and the next frame is tracked") {
  Device device("reference");
  StereoOdometry odometry(walk().walked.rig(), device);
  StereoFrame frame = walk().pairs[0].view();
  const Image small(320, 199), words(320, 200, 65535);
  frame.left_mask = small.view();
  CHECK_THROWS_WITH(odometry.track(frame), Contains("the left mask has 320x199 pixels, its image has 320x200"));
  frame.left_mask = {};
  frame.right_mask = words.view();
  CHECK_THROWS_WITH(odometry.track(frame), Contains("the right mask") && Contains("8 bits"));
  frame.right_mask = {};
  CHECK(odometry.track(frame).status == FrameStatus::first);
}

TEST_CASE("run: --masks reads a mask per image", "[cli][device]") {
  const TemporaryFolder folder;
  const std::string images = dataset_files::write_kitti(folder / "kitti", 3), masks = folder / "masks";
  const auto run = [&] {
    return run_program({"run", folder / "kitti", "-o", folder / "out", "--masks", masks, "--force", "--quiet",
                        "--min-tracked", "0", "--device", "reference"});
  };
  const auto refused = [&](const std::string& text) {
    const auto result = run();
    CHECK(result.code == 3);
    CHECK_THAT(result.err, Contains(text));
  };
  refused("no folder left or right");
  for (const char* name : {"000000", "000001", "000002"})
    dataset_files::write_image(masks + "/left/" + name + ".png", 32, 24);
  CHECK(run().code == 0);
  dataset_files::write_image(masks + "/left/000001.png", 31, 24);
  refused("left/000001.png: found a mask of 31 x 24 pixels");
  std::filesystem::remove(masks + "/left/000001.png");
  refused("left/000001.png: found no file");
}

TEST_CASE("frame masks: masks that hide everything are named where there are no edges") {
  Device device("reference");
  StereoOdometry odometry(walk().walked.rig(), device);
  StereoFrame frame = walk().pairs[0].view();
  const Image black(320, 200);
  frame.left_mask = black.view();
  const FrameResult result = odometry.track(frame);
  CHECK(result.status == FrameStatus::lost_too_few_edges);
  CHECK_THAT(result.message, Contains("the masks hide 100 % of the left image"));
}

TEST_CASE("frame masks: a mask in the alpha channel is refused, an opaque one is read") {
  const TemporaryFolder folder;
  const std::string file = folder / "alpha.png";
  StereoRig rig = walk().walked.rig();
  cv::Mat drawn(200, 320, CV_8UC4, cv::Scalar(255, 255, 255, 255));
  drawn.rowRange(0, 50).setTo(cv::Scalar(0, 0, 0, 255));
  REQUIRE(cv::imwrite(file, drawn));
  mask_rig(rig, file);
  CHECK(std::count(rig.left_mask.hidden.begin(), rig.left_mask.hidden.end(), 1) == 50 * 320);
  drawn.setTo(cv::Scalar(255, 255, 255, 0));
  drawn.rowRange(50, 200).setTo(cv::Scalar(255, 255, 255, 255));
  REQUIRE(cv::imwrite(file, drawn));
  CHECK_THROWS_WITH(mask_rig(rig, file), Contains("transparent pixels"));
}
