#include <catch2/catch.hpp>
#include <random>

#include "rig/synchronisation.hpp"

using quadedge::rig::Synchronisation;

namespace {

/// Frames whose images shift by up to 4 px as the rig rolls and pitches, with a right camera that is `late` frames late
/// and a calibration that is off by up to 0.6 px.
Synchronisation watched(double late, double calibration) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.1);
  std::uniform_real_distribution<double> place(-0.5, 0.5);
  Synchronisation synchronisation;
  for (int frame = 0; frame < 12; ++frame) {
    std::vector<Synchronisation::Fit::Row> rows;
    for (int i = 0; i < 100; ++i) {
      const double u = place(random), v = place(random);
      const double motion = 3 * std::sin(0.7 * frame) + 2 * u * std::cos(1.1 * frame);
      rows.push_back(
          Synchronisation::row(u, v, calibration * (0.3 + u * v - v * v) - late * motion + noise(random), motion));
    }
    synchronisation.add(rows);
  }
  return synchronisation;
}

}  // namespace

TEST_CASE("synchronisation: the time offset of a late or early camera is measured", "[rig]") {
  CHECK(watched(1, 0).time_offset_frames() == Approx(1).margin(0.02));
  CHECK(watched(1, 2).time_offset_frames() == Approx(1).margin(0.02));
  CHECK(watched(-0.5, 0).time_offset_frames() == Approx(-0.5).margin(0.02));
}

TEST_CASE("synchronisation: calibration errors and too few samples give no time offset", "[rig]") {
  CHECK(watched(0, 0).time_offset_frames() == 0);
  CHECK(watched(0, 2).time_offset_frames() == 0);
  CHECK(watched(0.05, 0).time_offset_frames() == 0);  // below the warning threshold
  CHECK(watched(9, 0).time_offset_frames() == 0);     // no two cameras are so far apart: another error of the rig
  Synchronisation still;                              // no motion: the time offset cannot be measured
  std::vector<Synchronisation::Fit::Row> rows;
  for (int i = 0; i < 1000; ++i) rows.push_back(Synchronisation::row(0.001 * (i % 100), 0.01 * (i % 7), 0.5, 0));
  still.add(rows);
  CHECK(still.time_offset_frames() == 0);
  CHECK_FALSE(still.is_settled());
  CHECK(watched(0, 2).is_settled());
}
