#include "geometry/undistortion.hpp"
#include "testing.hpp"

using namespace quadedge;

namespace {

StereoRig rig_of(double left_focal, int left_width, double right_focal, int right_width) {
  StereoRig rig;
  rig.left = {left_focal, left_focal, 0.5 * left_width - 0.5, 40, left_width, 81};
  rig.right = {right_focal, right_focal, 0.5 * right_width - 0.5, 40, right_width, 81};
  rig.right_from_left.translation().x() = -0.1;
  return rig;
}

}  // namespace

TEST_CASE("equal scale: a camera with twice the resolution is halved and keeps its rays") {
  const StereoRig rig = rig_of(300, 400, 150, 200), equal = with_equal_scales(rig);
  CHECK(equal.right.fx == 150);
  CHECK(equal.right_undistortion.empty());
  CHECK(equal.left.width == 200);
  CHECK(equal.left.height == 40);
  CHECK(equal.left.fx == 150);
  const UndistortionTable& table = equal.left_undistortion;
  REQUIRE(table.source_x.size() == 200 * 40);
  for (const int x : {0, 17, 199}) {
    for (const int y : {0, 5, 39}) {
      const std::size_t i = static_cast<std::size_t>(200 * y + x);
      // At the centre of the four pixels that it averages, and on the same ray.
      CHECK(table.source_x[i] == 2 * static_cast<float>(x) + 0.5F);
      CHECK(table.source_y[i] == 2 * static_cast<float>(y) + 0.5F);
      CHECK((equal.left.ray({x, y}) - rig.left.ray({table.source_x[i], table.source_y[i]})).norm() < 1e-6);
    }
  }
}

TEST_CASE("equal scale: an undistortion table is rescaled, and other rigs stay unchanged") {
  StereoRig rig = rig_of(150, 200, 300, 400);
  UndistortionTable& table = rig.right_undistortion;
  table.width = 400;
  table.height = 81;
  for (int y = 0; y < 81; ++y) {
    for (int x = 0; x < 400; ++x) {
      table.source_x.change().push_back(static_cast<float>(3 * x + y));
      table.source_y.change().push_back(static_cast<float>(2 * y));
    }
  }
  const StereoRig equal = with_equal_scales(rig);
  CHECK(equal.left_undistortion.empty());
  const std::size_t i = 200 * 7 + 11;  // between (22, 14) and (23, 15)
  CHECK(equal.right_undistortion.source_x[i] == Approx(3 * 22.5 + 14.5));
  CHECK(equal.right_undistortion.source_y[i] == Approx(2 * 14.5));
  const StereoRig alike = with_equal_scales(rig_of(300, 400, 240, 400));
  CHECK(alike.left.width == 400);
  CHECK(alike.left_undistortion.empty());
  CHECK(alike.right_undistortion.empty());
}
