#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "report/canvas.hpp"
#include "report/drawing.hpp"
#include "temporary_folder.hpp"

using namespace quadedge;
using namespace quadedge::evaluation;
using namespace quadedge::report;

namespace {

constexpr int kViewWidth = 250, kViewHeight = 80, kScale = 4, kRightView = kViewWidth * kScale;

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

cv::Mat drawn(const DrawnFrame& frame, MatchClass kind) {
  const TemporaryFolder folder;
  draw_matches(folder / "matches.png", frame, "paper", {}, kind);
  return cv::imread(folder / "matches.png");
}

/// Colour at a position in one of the views of the whole images.
cv::Vec3b at(const cv::Mat& picture, double x, double y, Side side) {
  return picture.at<cv::Vec3b>(
      static_cast<int>(std::lround((y + 0.5) * kScale - 0.5)),
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

/// The strongest colour of a marker around a position.
cv::Vec3b marker_at(const cv::Mat& picture, double x, double y, Side side) {
  cv::Vec3b strongest;
  for (const double dx : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    for (const double dy : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
      const auto colour = at(picture, x + dx, y + dy, side);
      if (colourfulness(colour) > colourfulness(strongest)) strongest = colour;
    }
  }
  return strongest;
}

}  // namespace

TEST_CASE("Every correct match has a colour of its own, the same in both views", "[report]") {
  const cv::Mat picture = drawn(small_frame(), MatchClass::correct);
  const auto first = at(picture, 60, 20, Side::left), second = at(picture, 90, 40, Side::left);
  CHECK(difference(first, at(picture, 50, 20, Side::right)) < 20);
  CHECK(difference(second, at(picture, 80.5, 40, Side::right)) < 20);
  CHECK(difference(first, second) > 60);
  CHECK(colourfulness(at(picture, 120, 60, Side::left)) == 0);  // of another class
  // Below the views, the regions with correct matches are shown again, larger, in the same colours.
  const cv::Mat below = picture.rowRange(kViewHeight * kScale + 8, picture.rows - 34);
  for (const auto& colour : {first, second}) {
    int found = 0;
    for (int y = 0; y < below.rows; ++y)
      for (int x = 0; x < below.cols; ++x) found += difference(below.at<cv::Vec3b>(y, x), colour) < 40;
    CHECK(found > 20);
  }
}

TEST_CASE("Matches that are not correct have pictures of their own, linked to the true position in the right view",
          "[report]") {
  const cv::Mat picture = drawn(small_frame(), MatchClass::wrong);
  CHECK(colourfulness(at(picture, 120, 30, Side::right)) > 50);  // on the line from 100 to 140
  CHECK(colourfulness(at(picture, 120, 30, Side::left)) == 0);
  CHECK(colourfulness(at(picture, 150, 30, Side::left)) > 50);
  CHECK(colourfulness(marker_at(picture, 120, 60, Side::left)) == 0);  // an inaccurate one
  CHECK(colourfulness(marker_at(drawn(small_frame(), MatchClass::inaccurate), 120, 60, Side::left)) > 50);
  DrawnFrame other = small_frame();
  other.matches[3].true_x = std::nanf("");
  other.matches[3].kind = MatchClass::occluded;
  CHECK(colourfulness(at(drawn(other, MatchClass::wrong), 120, 30, Side::right)) == 0);
  CHECK(colourfulness(marker_at(drawn(other, MatchClass::wrong), 148.7, 28.7, Side::left)) > 50);  // a square
  other.right = Image(60, 120);  // another size than the left one
  CHECK(drawn(other, MatchClass::correct).rows > 120 * kScale);
}

TEST_CASE("Drawings are written one file per result, and repeated names are made unique", "[report]") {
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
  CHECK(names == std::vector<std::string>{"a_b_c_2_correct.png", "a_b_c_2_inaccurate.png", "a_b_c_2_wrong.png",
                                          "a_b_c_correct.png", "a_b_c_inaccurate.png", "a_b_c_wrong.png"});
  CHECK(cv::imread(folder / "new/a_b_c_correct.png").cols == 2 * kRightView);
}
