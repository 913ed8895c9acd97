#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "report/canvas.hpp"
#include "report/draw_matches.hpp"
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

cv::Mat drawn(const DrawnFrame& frame) {
  const TemporaryFolder folder;
  draw_matches(folder / "matches.png", frame, "paper", {});
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

TEST_CASE("Drawn by class, every class has one colour in both views, unlike the others", "[report]") {
  const cv::Mat picture = drawn(small_frame());
  const auto correct = at(picture, 60, 20, Side::left), inaccurate = marker_at(picture, 120, 60, Side::left),
             wrong = at(picture, 150, 30, Side::left);
  CHECK(difference(correct, at(picture, 90, 40, Side::left)) < 20);
  CHECK(difference(correct, at(picture, 80.5, 40, Side::right)) < 20);
  CHECK(difference(inaccurate, marker_at(picture, 105, 60, Side::right)) < 20);
  CHECK(difference(correct, inaccurate) > 60);
  CHECK(difference(inaccurate, wrong) > 60);
  CHECK(difference(correct, wrong) > 60);
  // Shapes differ too: the cross of a wrong match leaves the edge's direction.
  CHECK(difference(wrong, picture.at<cv::Vec3b>(30 * kScale + 2 + 3, 150 * kScale + 2 + 3)) < 60);
}

TEST_CASE("Matches that are not correct are linked to their true position in the right view alone", "[report]") {
  const cv::Mat picture = drawn(small_frame());
  CHECK(colourfulness(at(picture, 120, 30, Side::right)) > 50);  // on the line from 100 to 140
  CHECK(colourfulness(at(picture, 120, 30, Side::left)) == 0);
  DrawnFrame other = small_frame();
  other.matches[3].true_x = std::nanf("");
  CHECK(colourfulness(at(drawn(other), 120, 30, Side::right)) == 0);
  other.right = Image(60, 120);  // another size than the left one
  CHECK(drawn(other).rows > 120 * kScale);
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
  CHECK(names == std::vector<std::string>{"a_b_c.png", "a_b_c_2.png"});
  CHECK(cv::imread(folder / "new/a_b_c.png").cols == 2 * kRightView);
}
