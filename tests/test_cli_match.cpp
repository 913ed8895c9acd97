#include <set>

#include "csv_table.hpp"
#include "dataset_files.hpp"
#include "own_camera.hpp"

using Catch::Matchers::Contains;

namespace {

const quadedge::FrameFiles& pair() { return own_camera::small_dataset().frames[1]; }

}  // namespace

TEST_CASE("match: left points equal those of the edges command, and 3D points fit the disparities", "[cli][device]") {
  const TemporaryFolder folder;
  const std::string calibration = own_camera::write_calibration_of_small(folder / "rig.yaml");
  run_well({"match", pair().left, pair().right, "--calibration", calibration, "--csv", folder / "matches.csv", "--ply",
            folder / "points.ply", "--draw", folder / "m.png"});
  run_well({"edges", pair().left, "--csv", folder / "edges.csv"});
  std::set<std::string> edges;
  for (const auto& row : read_lines(folder / "edges.csv")) edges.insert(row.substr(0, row.rfind(',')));
  const auto rows = read_lines(folder / "matches.csv");
  REQUIRE(rows.size() > 200);
  CHECK(rows[0] == "left_x,left_y,left_direction_rad,right_x,right_y,right_direction_rad,ncc,x_m,y_m,z_m");
  const auto& rig = own_camera::small_dataset().rig;
  std::size_t strangers = 0, points = 0, wrong = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto row = csv_fields(rows[i]);
    REQUIRE(row.size() == 10);
    strangers += edges.count(row[0] + "," + row[1] + "," + row[2]) == 0 ? 1 : 0;
    if (row[9].empty()) continue;
    ++points;
    // A rectified pair: depth = f b / disparity.
    const double z =
        rig.left.fx * rig.baseline() / (std::stod(row[0]) - std::stod(row[3]) + rig.right.cx - rig.left.cx);
    const double x = (std::stod(row[0]) - rig.left.cx) / rig.left.fx * z;
    wrong += std::abs(z - std::stod(row[9])) > 1e-3 * z || std::abs(x - std::stod(row[7])) > 1e-3 * z ? 1 : 0;
    CHECK(std::abs(std::stod(row[6])) <= 1);
  }
  CHECK(strangers == 0);
  CHECK(points > rows.size() / 2);
  CHECK(wrong == 0);
  CHECK_THAT(read_text(folder / "points.ply").substr(0, 200), Contains("element vertex " + std::to_string(points)));
  CHECK(read_text(folder / "m.png").substr(1, 3) == "PNG");
}

TEST_CASE("match: rectified images without a calibration have matches but no 3D points", "[cli][device]") {
  const TemporaryFolder folder;
  const std::vector<std::string> match = {"match", pair().left, pair().right,          "--stereo.max_disparity",
                                          "40",    "--csv",     folder / "matches.csv"};
  run_well(match);
  const auto rows = read_lines(folder / "matches.csv");
  REQUIRE(rows.size() > 200);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto row = csv_fields(rows[i]);
    REQUIRE(row.size() == 10);
    CHECK((row[7].empty() && row[8].empty() && row[9].empty()));
    const double disparity = std::stod(row[0]) - std::stod(row[3]);
    CHECK((disparity > -1 && disparity < 41));
  }
  check_error(match, 2);  // the file exists
  check_error({"match", pair().left, pair().right, "--stereo.max_disparity", "40", "--ply", folder / "points.ply"}, 2,
              {"--calibration"});
}

TEST_CASE("match: invalid pairs are refused", "[cli]") {
  const TemporaryFolder folder;
  dataset_files::write_image(folder / "small.png");
  dataset_files::write_image(folder / "deep.png", 320, 200, CV_16UC1);
  const std::string calibration = own_camera::write_calibration_of_small(folder / "rig.yaml");
  check_error({"match"}, 2);
  check_error({"match", pair().left}, 2);
  check_error({"match", pair().left, folder / "small.png"}, 3, {"small.png", "24 rows"});
  check_error({"match", pair().left, folder / "deep.png"}, 3, {"deep.png", "65535"});
  check_error({"match", pair().left, folder / "small.png", "--calibration", calibration}, 3, {"small.png", "32 x 24"});
  check_error({"match", pair().left, folder / "absent.png"}, 3);
}
