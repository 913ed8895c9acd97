#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "evaluation/edge_truth.hpp"
#include "quadedge/camera.hpp"

using namespace quadedge;
using namespace quadedge::evaluation;

namespace {

constexpr double kVerticalLine = kPi / 2, kHorizontal = 0;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

template <class Value>
SurfaceMap make_map(int width, int height, const Value& value) {
  SurfaceMap map{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) map.nearness.push_back(static_cast<float>(value(x, y)));
  }
  return map;
}

/// A board (20 px) left of column 15.5 in front of a wall (5 px).
SurfaceMap board() {
  return make_map(40, 30, [](int x, int) { return x <= 15 ? 20.0 : 5.0; });
}

}  // namespace

TEST_CASE("A slanted surface is interpolated exactly", "[matching]") {
  const auto map = make_map(40, 30, [](int x, int y) { return 10 + 0.3 * x - 0.2 * y; });
  const auto point = surface_at(map, 12.37, 17.81, 0.4);
  REQUIRE(point);
  CHECK(point->nearness == Approx(10 + 0.3 * 12.37 - 0.2 * 17.81).margin(1e-5));
  CHECK_FALSE(point->contour);
}

TEST_CASE("An edge on a depth step belongs to the nearer surface, whichever side of the step it was detected on",
          "[matching]") {
  for (const double x : {14.6, 15.4, 16.0, 16.8}) {
    const auto point = surface_at(board(), x, 12.3, kVerticalLine);
    REQUIRE(point);
    CHECK(point->contour);
    CHECK(point->nearness == Approx(20));
  }
}

TEST_CASE("Away from a depth step an edge belongs to its side, just beside the step it has no depth", "[matching]") {
  CHECK(surface_at(board(), 13.2, 12, kVerticalLine)->nearness == Approx(20));
  CHECK_FALSE(surface_at(board(), 13.2, 12, kVerticalLine)->contour);
  CHECK_FALSE(surface_at(board(), 17.7, 12, kVerticalLine));
  CHECK(surface_at(board(), 19.0, 12, kVerticalLine)->nearness == Approx(5));
}

TEST_CASE("A depth step at the end of an edge does not affect its depth", "[matching]") {
  const auto near_side = surface_at(board(), 15.3, 12.5, kHorizontal),
             far_side = surface_at(board(), 15.8, 12.5, kHorizontal);
  REQUIRE(near_side);
  REQUIRE(far_side);
  CHECK(near_side->nearness == Approx(20));
  CHECK(far_side->nearness == Approx(5));
  CHECK_FALSE(far_side->contour);
}

TEST_CASE("An edge next to an unknown pixel has no depth", "[matching]") {
  const auto map = make_map(40, 30, [](int x, int) { return x == 20 ? static_cast<double>(kNan) : 5.0; });
  CHECK_FALSE(surface_at(map, 20.2, 12, kVerticalLine));
  CHECK_FALSE(surface_at(map, 21.2, 12, kVerticalLine));
  CHECK(surface_at(map, 22.4, 12, kVerticalLine));
  CHECK(surface_at(map, 21.2, 12, kHorizontal));
}

TEST_CASE("Infinite and missing values in disparity and depth files are unknown", "[matching]") {
  const float infinite = std::numeric_limits<float>::infinity();
  const auto disparity = surface_from_disparity({4, 1, {2.5F, infinite, 0.0F, -1.0F}}, 2);
  CHECK(disparity.nearness[0] == 5.0F);
  for (const std::size_t i : {1, 2, 3}) CHECK(std::isnan(disparity.nearness[i]));
  Image grey(2, 1);
  grey.pixels = {0, 30};
  CHECK(std::isnan(surface_from_grey(grey, 0.25).nearness[0]));
  CHECK(surface_from_grey(grey, 0.25).nearness[1] == 7.5F);
  const auto depth = surface_from_depth({2, 1, {0.0F, 4.0F}}, 30);
  CHECK(std::isnan(depth.nearness[0]));
  CHECK(depth.nearness[1] == 7.5F);
}

TEST_CASE("A point is visible, occluded by a nearer surface, or contradicted", "[matching]") {
  const auto map = board();
  CHECK(visibility(map, 10, 10, 20.6) == Visibility::visible);
  CHECK(visibility(map, 10, 10, 5) == Visibility::occluded);
  CHECK(visibility(map, 30, 10, 20) == Visibility::unknown);
  CHECK(visibility(map, -0.5, 10, 20) == Visibility::occluded);
  CHECK(visibility(make_map(9, 9, [](int, int) { return static_cast<double>(kNan); }), 4, 4, 5) == Visibility::unknown);
}

TEST_CASE("In the right view a board occludes the part of the wall beside it", "[matching]") {
  // Columns 20 to 29 of the left view show a board of 8 px, the rest a wall of 2 px: the board covers columns 12 to 21.
  const auto left = make_map(60, 9, [](int x, int) { return x >= 20 && x < 30 ? 8.0 : 2.0; });
  const auto right = right_from_left(left, 60);
  for (int x = 0; x < 50; ++x) {
    const float value = right.nearest(x, 4);
    INFO(x);
    if (x >= 12 && x <= 21) {
      CHECK(value == 8.0F);
    } else if (x >= 22 && x < 28) {
      CHECK(std::isnan(value));  // the part of the wall that only the right camera sees
    } else {
      CHECK(value == 2.0F);
    }
  }
  // The wall's column 16 maps to column 14, behind the board; column 10 to 8, beside it.
  FrameTruth truth;
  truth.left = left;
  truth.right = right;
  const std::vector<float> x = {16, 10, 35}, y = {4, 4, 4}, direction = {0, 0, 0};
  const auto positions = true_right_positions({}, truth, {x, y, direction});
  CHECK(positions.state[0] == Visibility::occluded);
  CHECK(positions.state[1] == Visibility::visible);
  CHECK(positions.state[2] == Visibility::visible);
  CHECK(positions.x[1] == 8.0F);
}

TEST_CASE("A point of known depth is located after a known motion", "[matching]") {
  StereoRig rig;
  rig.left = rig.right = {200, 200, 49.5, 39.5, 100, 80};
  rig.right_from_left.translation().x() = -0.1;
  const double scale = 200 * 0.1;
  FrameTruth before, now;
  before.depth_scale = now.depth_scale = scale;
  before.left = before.right = make_map(100, 80, [&](int, int) { return scale / 2.0; });  // a wall 2 m away
  before.world_from_left = now.world_from_left = Eigen::Isometry3d::Identity();
  now.world_from_left->translation() = Eigen::Vector3d(0.1, 0, 0.4);  // the wall is 1.6 m away now
  now.left = now.right =
      make_map(100, 80, [&](int x, int) { return x < 20 ? 2 * scale / 1.6 : scale / 1.6; });  // a nearer obstacle
  const std::vector<float> x = {59.5F, 36.5F}, y = {49.5F, 39.5F}, direction = {1.5F, 1.5F};
  // Offsets from the principal point: X = 10 px * 2 m / 200 px = 0.1 m, minus 0.1 m; Y = 0.1 m; then the right camera
  // 0.1 m farther.
  const auto left = true_later_positions(rig, before, now, Side::left, {x, y, direction});
  CHECK(left.x[0] == Approx(49.5));
  CHECK(left.y[0] == Approx(39.5 + 200 * 0.1 / 1.6));
  CHECK(left.state[0] == Visibility::visible);
  const auto right = true_later_positions(rig, before, now, Side::right, {x, y, direction});
  CHECK(right.x[0] == Approx(49.5 - 200 * 0.1 / 1.6));
  // X = -13 px * 2 m / 200 px - 0.1 m = -0.23 m: column 49.5 - 28.75 = 20.75 in the left view, 8.25 behind the obstacle
  // in the right.
  CHECK(left.x[1] == Approx(20.75));
  CHECK(left.state[1] == Visibility::visible);
  CHECK(right.state[1] == Visibility::occluded);
  const auto stereo = true_right_positions(rig, before, {x, y, direction});
  CHECK(stereo.x[0] == Approx(49.5));
  CHECK(stereo.y[0] == Approx(49.5));
}
