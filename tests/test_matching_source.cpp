#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <opencv2/imgcodecs.hpp>

#include "data/float_map.hpp"
#include "dataset_files.hpp"
#include "evaluation/matching_source.hpp"
#include "quadedge/error.hpp"
#include "temporary_folder.hpp"

using namespace quadedge;
using namespace quadedge::evaluation;
using namespace dataset_files;

namespace {

constexpr int kWidth = 48, kHeight = 24;
constexpr float kVertical = 1.5707963F;

/// An ETH3D pair of a wall at 6 px, with a board at 12 px in columns 30 to 39 of the left view.
std::string write_pair(const std::string& root) {
  const std::string folder = root + "/two_view_training/scene";
  write_image(folder + "/im0.png", kWidth, kHeight);
  write_image(folder + "/im1.png", kWidth, kHeight);
  data::FloatMap disparity{kWidth, kHeight, {}};
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const int x = i % kWidth;
    disparity.values.push_back(x >= 30 && x < 40 ? 12.0F : 6.0F);
  }
  data::write_float_map(folder + "/disp0GT.pfm", disparity);
  return folder;
}

void write_mask(const std::string& folder) {
  cv::Mat mask(kHeight, kWidth, CV_8UC1, cv::Scalar(255));
  mask.col(20) = 128;
  mask.col(12) = 0;
  mask.col(29) = 128;  // the wall just beside the board, which occludes it
  REQUIRE(cv::imwrite(folder + "/mask0nocc.png", mask));
}

TruePositions positions(const MatchingSource& source, const std::vector<float>& x) {
  const TrueFrame frame = source.load(0);
  const std::vector<float> y(x.size(), 12), direction(x.size(), kVertical);
  return true_right_positions(source.rig(), frame.truth, {x, y, direction});
}

}  // namespace

TEST_CASE("Without a mask, occlusion follows from the disparities", "[matching][io]") {
  const TemporaryFolder folder;
  const auto source = make_recorded_source(open_dataset(write_pair(folder.path())));
  // Column 25 of the wall maps to column 19 of the right view, which shows the board (30 - 12 = 18 to 27).
  const auto found = positions(*source, {20, 25, 35, 12});
  CHECK(found.state ==
        std::vector<Visibility>{Visibility::visible, Visibility::occluded, Visibility::visible, Visibility::visible});
  CHECK(found.x[0] == 14);
  CHECK(found.x[2] == 23);
}

TEST_CASE("A mask marks occluded and unknown pixels, but not the contour of a nearer surface", "[matching][io]") {
  const TemporaryFolder folder;
  const std::string path = write_pair(folder.path());
  write_mask(path);
  const auto source = make_recorded_source(open_dataset(path));
  // 12: unknown; 13: next to an unknown pixel; 16: neither; 20: occluded; 29.4: the board's contour, though the pixel
  // is marked.
  const auto found = positions(*source, {12, 13, 16, 20, 29.4F});
  CHECK(found.state == std::vector<Visibility>{Visibility::unknown, Visibility::unknown, Visibility::visible,
                                               Visibility::occluded, Visibility::visible});
  CHECK(found.contour[4] == 1);
  CHECK(found.x[4] == Approx(29.4 - 12));
}

TEST_CASE("A mask or a disparity map of the wrong size is refused by name", "[matching][io]") {
  const TemporaryFolder folder;
  const std::string path = write_pair(folder.path());
  REQUIRE(cv::imwrite(path + "/mask0nocc.png", cv::Mat(kHeight, kWidth - 1, CV_8UC1, cv::Scalar(255))));
  const auto source = make_recorded_source(open_dataset(path));
  CHECK_THROWS_WITH(source->load(0), Catch::Contains("mask0nocc.png"));
  CHECK_THROWS_AS(source->load(0), DataError);
}

TEST_CASE("Where the views disagree, measured disparities of the right view decide", "[matching][io]") {
  const TemporaryFolder folder;
  const std::string path = write_pair(folder.path());
  // The right view has 20 px everywhere: it shows neither the wall nor the board of the left view.
  data::write_float_map(path + "/disp1GT.pfm", {kWidth, kHeight, std::vector<float>(kWidth * kHeight, 20.0F)});
  const auto source = make_recorded_source(open_dataset(path));
  CHECK(source->load(0).truth.right_is_measured);
  const auto found = positions(*source, {16, 35});
  CHECK(found.state == std::vector<Visibility>{Visibility::occluded, Visibility::occluded});
}

TEST_CASE("A sequence of pairs has the disparities of every frame and, with poses, depths", "[matching][io]") {
  const TemporaryFolder folder;
  const std::string root = folder / "scene/stereo_pairs/";
  for (const char* name : {"1000000000.0", "1000000000.1"}) {
    write_image(root + name + "/im0.png", kWidth, kHeight);
    write_image(root + name + "/im1.png", kWidth, kHeight);
    const float disparity = name[11] == '0' ? 6.0F : 5.0F;
    data::write_float_map(root + name + "/disp0GT.pfm",
                          {kWidth, kHeight, std::vector<float>(kWidth * kHeight, disparity)});
    write_text(root + name + "/images.txt",
               std::string("1 1 0 0 0 0 0 ") + (name[11] == '0' ? "0" : "0.2") + " 1 im0.png\n");
    write_text(
        root + name + "/calib.txt",
        "cam0=[100 0 24; 0 100 12; 0 0 1]\ncam1=[100 0 24; 0 100 12; 0 0 1]\nbaseline=60\nwidth=48\nheight=24\n");
  }
  const auto source = make_recorded_source(open_dataset(folder / "scene"));
  const FrameTruth first = source->load(0).truth, second = source->load(1).truth;
  CHECK(first.left.nearness[100] == 6);
  CHECK(second.left.nearness[100] == 5);
  // The wall at 100 x 0.06 / 6 = 1 m is seen from 0.2 m further back, at 1.2 m: column 36 moves to 24 + 12 / 1.2.
  const std::vector<float> x = {36}, y = {12}, direction = {kVertical};
  const auto later = true_later_positions(source->rig(), first, second, Side::left, {x, y, direction});
  CHECK(later.x[0] == Approx(34));
  CHECK(later.state[0] == Visibility::visible);
  std::filesystem::remove(root + "1000000000.1/disp0GT.pfm");
  CHECK_THROWS_WITH(source->load(1), Catch::Contains("1000000000.1/disp0GT.pfm"));
}
