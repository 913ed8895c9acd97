#include <catch2/catch.hpp>
#include <random>

#include "rig/row_model.hpp"

using namespace quadedge;
using rig::RowModel;

namespace {

const PinholeCamera kCamera{400, 400, 320, 200, 640, 400};

/// Frames whose images shift by up to 4 px as the rig rolls and pitches, with a right camera that is `late` frames late
/// and a calibration that is off by up to 0.6 px.
RowModel watched(double late, double calibration, double moves = 1) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.1);
  std::uniform_real_distribution<double> place(-0.5, 0.5);
  RowModel rows(kCamera, rig::kTimeMemory);
  for (int frame = 0; frame < 12; ++frame) {
    std::vector<rig::CornerMatch> matches(100);
    for (rig::CornerMatch& match : matches) {
      const double u = place(random), v = place(random);
      match.right = {(u + 0.5) * kCamera.width, (v + 0.5) * kCamera.height};
      match.motion = Eigen::Vector2d(1, moves * (3 * std::sin(0.7 * frame) + 2 * u * std::cos(1.1 * frame)));
      match.across = calibration * (0.3 + u * v - v * v) - late * match.motion->y() + noise(random);
    }
    rows.add(matches);
  }
  return rows;
}

}  // namespace

TEST_CASE("row model: the time offset of a late or early camera is measured beside the rows", "[rig]") {
  CHECK(watched(1, 0).delay() == Approx(1).margin(0.02));
  CHECK(watched(1, 2).delay() == Approx(1).margin(0.02));
  CHECK(watched(-0.5, 0).delay() == Approx(-0.5).margin(0.02));
  for (const double v : {-0.4, 0.0, 0.4})
    CHECK(watched(1, 2).error().at(0.3, v) == Approx(2 * (0.3 + 0.3 * v - v * v)).margin(0.1));
}

TEST_CASE("row model: calibration errors and an image that does not move give no time offset", "[rig]") {
  for (const double calibration : {0, 2}) CHECK(watched(0, calibration).delay() == 0);
  CHECK(watched(0.05, 0).delay() == 0);  // below the warning threshold
  CHECK(watched(9, 0).delay() == 0);     // no two cameras are so far apart: another error of the rig
  CHECK(watched(0, 2, 0).delay() == 0);
  CHECK_FALSE(watched(0, 2, 0).would_show_delay());
  CHECK(watched(0, 2).would_show_delay());
}
