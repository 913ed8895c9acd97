#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <random>

#include "report/canvas.hpp"
#include "report/draw_matches.hpp"
#include "report/match_drawings.hpp"
#include "temporary_folder.hpp"

using namespace quadedge;
using namespace quadedge::evaluation;
using namespace quadedge::report;

namespace {

constexpr int kViewWidth = 190, kViewHeight = 80, kScale = 5, kTop = 2 * kLegendLine,
              kRightView = kViewWidth * kScale + 6;

DrawnFrame small_frame() {
  DrawnFrame frame;
  frame.left = Image(kViewWidth, kViewHeight);
  frame.right = Image(kViewWidth, kViewHeight);
  for (auto* image : {&frame.left, &frame.right})
    std::fill(image->pixels.begin(), image->pixels.end(), static_cast<std::uint8_t>(100));
  const auto add = [&](float left_x, float y, float right_x, float true_x, MatchClass kind) {
    frame.matches.push_back({left_x, y, 1.5F, right_x, y, 1.5F, true_x, y, kind});
  };
  add(60, 20, 50, 50, MatchClass::correct);
  add(90, 40, 80.5F, 80, MatchClass::correct);
  add(120, 60, 105, 110, MatchClass::inaccurate);
  add(150, 30, 100, 140, MatchClass::wrong);
  return frame;
}

/// Colour at a position in one of the views of the whole images.
cv::Vec3b at(const cv::Mat& picture, double x, double y, Side side) {
  return picture.at<cv::Vec3b>(
      kTop + static_cast<int>(std::lround((y + 0.5) * kScale - 0.5)),
      (side == Side::right ? kRightView : 0) + static_cast<int>(std::lround((x + 0.5) * kScale - 0.5)));
}

int colourfulness(const cv::Vec3b& colour) {
  return std::max({colour[0], colour[1], colour[2]}) - std::min({colour[0], colour[1], colour[2]});
}

int difference(const cv::Vec3b& a, const cv::Vec3b& b) {
  int largest = 0;
  for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(a[k] - b[k]));
  return largest;
}

}  // namespace

TEST_CASE("A correct match has the colour of its disparity in both views", "[report]") {
  const cv::Mat picture = draw_match_class(small_frame(), MatchClass::correct, "paper", 1, 10);
  const auto first = at(picture, 60, 20, Side::left), second = at(picture, 90, 40, Side::left);
  CHECK(colourfulness(first) > 50);
  CHECK(difference(first, at(picture, 50, 20, Side::right)) < 10);
  CHECK(difference(second, at(picture, 80.5, 40, Side::right)) < 10);
  CHECK(difference(first, second) < 40);  // 10 and 9.5 px
  DrawnFrame far = small_frame();
  far.matches[1].right_x = 88;  // 2 px instead of 10 px
  CHECK(difference(first, at(draw_match_class(far, MatchClass::correct, "paper", 1, 10), 90, 40, Side::left)) > 60);
  // Other classes are not drawn.
  CHECK(colourfulness(at(picture, 120, 60, Side::left)) == 0);
  CHECK(colourfulness(at(picture, 100, 30, Side::right)) == 0);
}

TEST_CASE("Inaccurate and wrong matches are linked to their true position in the right view", "[report]") {
  const cv::Mat picture = draw_match_class(small_frame(), MatchClass::wrong, "paper", 1, 10);
  const auto match = at(picture, 150, 30, Side::left);
  CHECK(colourfulness(match) > 100);
  CHECK(difference(match, at(picture, 100, 30, Side::right)) < 10);
  CHECK(colourfulness(at(picture, 120, 30, Side::right)) > 50);  // on the line from 100 to 140
  CHECK(colourfulness(at(picture, 120, 30, Side::left)) == 0);
  CHECK(colourfulness(at(picture, 60, 20, Side::left)) == 0);
}

TEST_CASE("Drawn by class, every class has one colour in both views, unlike the others", "[report]") {
  const cv::Mat picture = draw_all_matches(small_frame(), "paper", 1, 10);
  const auto correct = at(picture, 60, 20, Side::left), inaccurate = at(picture, 120, 60, Side::left),
             wrong = at(picture, 150, 30, Side::left);
  CHECK(difference(correct, at(picture, 90, 40, Side::left)) < 20);
  CHECK(difference(correct, at(picture, 80.5, 40, Side::right)) < 20);
  CHECK(difference(inaccurate, at(picture, 105, 60, Side::right)) < 20);
  CHECK(difference(correct, inaccurate) > 60);
  CHECK(difference(inaccurate, wrong) > 60);
  CHECK(difference(correct, wrong) > 60);
  // Shapes differ too: the cross of a wrong match leaves the edge's direction.
  CHECK(difference(wrong, picture.at<cv::Vec3b>(kTop + 30 * kScale + 2 + 3, 150 * kScale + 2 + 3)) < 60);
}

TEST_CASE("Details below the images enlarge the neighbourhood of matches", "[report]") {
  const cv::Mat with = draw_match_class(small_frame(), MatchClass::correct, "paper", 1, 10);
  DrawnFrame tiny = small_frame();
  tiny.left = tiny.right = Image(40, 30);  // smaller than a detail
  tiny.matches.clear();
  const cv::Mat without = draw_match_class(tiny, MatchClass::correct, "paper", 1, 10);
  CHECK(with.rows > kTop + kViewHeight * kScale + 100);
  CHECK(without.rows == kTop + 30 * (1900 / 80));
  // Some pixel below the images is coloured.
  const cv::Mat below = with.rowRange(kTop + kViewHeight * kScale + 8, with.rows);
  int colourful = 0;
  for (int y = 0; y < below.rows; ++y) {
    for (int x = 0; x < below.cols; ++x) colourful += colourfulness(below.at<cv::Vec3b>(y, x)) > 100 ? 1 : 0;
  }
  CHECK(colourful > 20);
}

TEST_CASE("Drawings are written one file per class present, and repeated names are made unique", "[report]") {
  const TemporaryFolder folder;
  MatchingResult result;
  result.name = "a/b c";
  result.drawn = small_frame();
  MatchingResult blind;
  blind.name = "nothing drawn";
  write_match_drawings(folder / "new", {result, blind, result}, {});
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "new"))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{"a_b_c_2_all.png", "a_b_c_2_correct.png", "a_b_c_2_inaccurate.png",
                                          "a_b_c_2_wrong.png", "a_b_c_all.png", "a_b_c_correct.png",
                                          "a_b_c_inaccurate.png", "a_b_c_wrong.png"});
  CHECK(cv::imread(folder / "new/a_b_c_all.png").cols == 2 * kViewWidth * kScale + 6);
}
