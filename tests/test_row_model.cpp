#include <catch2/catch.hpp>
#include <random>

#include "rig/row_model.hpp"

using namespace quadedge;
using rig::RowModel;

namespace {

constexpr int kWidth = 640, kHeight = 400;

rig::CornerMatch match_at(double u, double v, double across, double motion) {
  rig::CornerMatch match;
  match.right = {(u + 0.5) * kWidth, (v + 0.5) * kHeight};
  match.across = across;
  match.motion = Eigen::Vector2d(1, motion);  // across the line, which is a row
  return match;
}

RowModel model() { return RowModel({400, 400, 320, 200, kWidth, kHeight}, rig::kTimeMemory); }

/// Frames whose images shift by up to 4 px as the rig rolls and pitches, with a right camera that is `late` frames late
/// and a calibration that is off by up to 0.6 px.
RowModel watched(double late, double calibration) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.1);
  std::uniform_real_distribution<double> place(-0.5, 0.5);
  RowModel rows = model();
  for (int frame = 0; frame < 12; ++frame) {
    std::vector<rig::CornerMatch> matches;
    for (int i = 0; i < 100; ++i) {
      const double u = place(random), v = place(random);
      const double motion = 3 * std::sin(0.7 * frame) + 2 * u * std::cos(1.1 * frame);
      matches.push_back(match_at(u, v, calibration * (0.3 + u * v - v * v) - late * motion + noise(random), motion));
    }
    rows.add(matches);
  }
  return rows;
}

}  // namespace

TEST_CASE("row model: the time offset of a late or early camera is measured", "[rig]") {
  CHECK(watched(1, 0).delay() == Approx(1).margin(0.02));
  CHECK(watched(1, 2).delay() == Approx(1).margin(0.02));
  CHECK(watched(-0.5, 0).delay() == Approx(-0.5).margin(0.02));
}

TEST_CASE("row model: a late camera leaves the rows as they are", "[rig]") {
  const RectificationError rows = watched(1, 2).error();
  for (const double v : {-0.4, 0.0, 0.4}) CHECK(rows.at(0.3, v) == Approx(2 * (0.3 + 0.3 * v - v * v)).margin(0.1));
}

TEST_CASE("row model: calibration errors and too few matches give no time offset", "[rig]") {
  CHECK(watched(0, 0).delay() == 0);
  CHECK(watched(0, 2).delay() == 0);
  CHECK(watched(0.05, 0).delay() == 0);  // below the warning threshold
  CHECK(watched(9, 0).delay() == 0);     // no two cameras are so far apart: another error of the rig
  RowModel still = model();              // no motion: the time offset cannot be measured
  std::vector<rig::CornerMatch> matches;
  for (int i = 0; i < 1000; ++i) matches.push_back(match_at(0.001 * (i % 100), 0.01 * (i % 7), 0.5, 0));
  still.add(matches);
  CHECK(still.delay() == 0);
  CHECK_FALSE(still.would_show_delay());
  CHECK(watched(0, 2).would_show_delay());
}
