#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "csv_table.hpp"
#include "dataset_files.hpp"
#include "output/rig_maps.hpp"
#include "program.hpp"
#include "quadedge/camera.hpp"

using namespace quadedge;
using report::CellMap;

namespace {

constexpr double kFocal = 160, kPitch = 0.1, kRoll = 0.3;  // px, degrees

/// Of a camera turned up by kPitch and about its axis by kRoll: by how much a point at (x, y) px from the principal
/// point lies lower than the calibration says [px]. To first order in the angles.
double lower_by(double x, double y) {
  return kPitch * kDegree * kFocal * (1 + y * y / (kFocal * kFocal)) - kRoll * kDegree * x;
}

/// Two rendered recordings of a room along one path: `sound`, and `room`, whose right camera is turned. A run of the
/// latter with the calibration of the former gives the other members.
struct TurnedRig {
  TemporaryFolder folder;
  std::string calibration = folder / "rig.yaml";
  nlohmann::json rig;
  std::vector<double> x, y, before;  ///< of the cells of rows_before that have a median; from the principal point [px]

  TurnedRig(int frames, const std::string& turn) {
    for (const auto& [name, rotation] : {std::pair{"sound", std::string("0,0,0")}, std::pair{"room", turn}})
      REQUIRE(run_program({"synth", folder / name, "--path", "drive", "--frames", std::to_string(frames), "--size",
                           "320x200", "--focal", "160", "--right-rotation", rotation, "--quiet"})
                  .code == 0);
    REQUIRE(run_program({"check", folder / "sound", "--write-calibration", calibration, "--quiet"}).code == 0);
  }

  /// \param principal_x by how much the calibration's right principal point is off [px]
  void run(double principal_x = 0) {
    std::string text = read_text(calibration);
    const std::string key = "right_intrinsics: [160, 160, ";
    const std::size_t at = text.find(key) + key.size(), end = text.find(',', at);
    const double cx = std::stod(text.substr(at)), cy = std::stod(text.substr(end + 1));
    dataset_files::write_text(calibration, text.replace(at, end - at, std::to_string(cx + principal_x)));
    REQUIRE(run_program({"run", folder / "room", "--calibration", calibration, "-o", folder / "out", "--quiet",
                         "--pose.disparity_offset_sigma", "1"})
                .code == 0);
    rig = nlohmann::json::parse(read_text(folder / "out/report.json")).at("rig");
    const std::string cells = folder / "out/rig_maps.csv";
    const auto all = csv_numbers(cells, "rows_before"), columns = csv_numbers(cells, "x"),
               rows = csv_numbers(cells, "y");
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (std::isnan(all[i])) continue;
      before.push_back(all[i]);
      x.push_back(columns[i] - cx);
      y.push_back(rows[i] - cy);
    }
  }
};

}  // namespace

TEST_CASE("rig maps: medians of cells, their spread, and what noise leaves of them") {
  CellMap map;
  CHECK(map.summary().cells == 0);
  CHECK(std::isnan(map.summary().rms));
  for (int i = 0; i < 40; ++i) map.add(0.999, 0, i % 2 == 0 ? 1 : 3);
  for (int i = 0; i < 20; ++i) map.add(0, 0.999, -5);
  for (int i = 0; i < 19; ++i) map.add(0.5, 0.5, 100);
  for (const double outside : {-0.001, 1.0, std::nan("")}) map.add(outside, 0.5, 100);
  CHECK(map.median(11, 0) == 2);
  CHECK(map.median(0, 7) == -5);
  CHECK(std::isnan(map.median(6, 4)));  // of too few
  CHECK(map.samples(6, 4) == 19);
  CHECK(map.samples(0, 4) == 0);
  const CellMap::Summary summary = map.summary();
  CHECK(summary.cells == 2);
  CHECK(summary.largest == -5);
  CHECK(summary.rms == Approx(std::sqrt((4 + 25) / 2.0)));
  CHECK(summary.scatter == Approx(1.4826));  // 40 samples are 1 px off their medians, 20 are not
  CHECK(summary.noise == Approx(1.2533 * 1.4826 * std::sqrt((1 / 40.0 + 1 / 20.0) / 2)));
}

TEST_CASE("rig maps: the median of very many samples is that of all times") {
  CellMap map;
  for (int i = 0; i < 1000000; ++i) map.add(0.5, 0.5, i);
  CHECK(map.samples(6, 4) == 1000000);
  CHECK(map.median(6, 4) == Approx(5e5).epsilon(0.005));
}

TEST_CASE("rig maps: a turned right camera and a wrong principal point are on the maps before, not on those after",
          "[cli][device]") {
  TurnedRig turned(20, "0.1,0,0.3");
  turned.run(1);
  double squares = 0;
  for (std::size_t i = 0; i < turned.before.size(); ++i) {
    const double error = turned.before[i] - lower_by(turned.x[i], turned.y[i]);
    CHECK(std::abs(error) < 0.1);  // points of a cell may lie up to 13 px beside its middle, where roll shows 0.07 px
    squares += error * error;
  }
  const auto &rows = turned.rig["rows"], &columns = turned.rig["columns"], &offset = turned.rig["disparity_offset"];
  REQUIRE(turned.before.size() > 60);
  CHECK(turned.before.size() == rows["before"]["cells"]);
  CHECK(std::sqrt(squares / static_cast<double>(turned.before.size())) < 0.05);
  CHECK(rows["before"]["rms_px"] > 0.5);
  CHECK(rows["after"]["rms_px"] < 0.03);
  CHECK(turned.rig["row_correction_px"] == Approx(lower_by(-163, 103)).margin(0.1));  // in the lower left corner
  // The principal point lies 1 px too far right, so that all disparities are taken to be 1 px larger than they are.
  CHECK(offset["start"]["px"] == 0);
  CHECK(offset["start"]["sigma_px"] == 1);
  CHECK(offset["end"]["px"] == Approx(-1).margin(0.1));
  // As the scene approaches, disparities grow, but the excess of 1 px does not: the motion predicts too large ones.
  CHECK(columns["before"]["largest_px"] < -0.3);
  CHECK(columns["before"]["rms_px"] > 0.2);
  CHECK(columns["after"]["rms_px"] < 0.04);
}

TEST_CASE("rig maps: those of a sound rig show noise", "[cli][device]") {
  TurnedRig sound(20, "0,0,0");
  sound.run();
  for (const char* state : {"before", "after"}) {
    const auto& rows = sound.rig["rows"][state];
    CHECK(rows["rms_px"] < 2 * rows["noise_px"].get<double>());
    CHECK(rows["rms_px"] < 0.02);
    CHECK(sound.rig["columns"][state]["rms_px"] < 0.04);
  }
  CHECK(sound.rig["row_correction_px"] == 0);
}

TEST_CASE("rig maps: once a camera has turned, they are those of the new rig", "[cli][device]") {
  TurnedRig turned(40, "0.1,0,0.3");
  for (const auto& image : std::filesystem::directory_iterator(turned.folder / "room/rgb2")) {
    const std::string name = image.path().filename().string();  // the time [s], 20 frames per second
    if (std::stod(name) < 0.7)
      std::filesystem::copy_file(turned.folder / ("sound/rgb2/" + name), image.path(),
                                 std::filesystem::copy_options::overwrite_existing);
  }
  turned.run();
  CHECK(turned.before.size() > 60);
  for (std::size_t i = 0; i < turned.before.size(); ++i)
    CHECK(turned.before[i] == Approx(lower_by(turned.x[i], turned.y[i])).margin(0.1));
  CHECK(turned.rig["rows"]["after"]["rms_px"] < 0.03);
}
