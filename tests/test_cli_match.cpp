#include <set>

#include "dataset_files.hpp"
#include "own_camera.hpp"

using Catch::Matchers::Contains;

namespace {

std::vector<std::string> cells(const std::string& row) {
  std::vector<std::string> list(1);
  for (const char letter : row) {
    if (letter == ',')
      list.emplace_back();
    else
      list.back() += letter;
  }
  return list;
}

const quadedge::FrameFiles& pair() { return own_camera::small_dataset().frames[1]; }

}  // namespace

TEST_CASE("match: left points equal those of the edges command, and 3D points fit the disparities", "[cli][device]") {
  const TemporaryFolder folder;
  const std::string calibration = own_camera::write_calibration_of_small(folder / "rig.yaml");
  const auto result = run_program({"match", pair().left, pair().right, "--calibration", calibration, "--csv",
                                   folder / "matches.csv", "--ply", folder / "points.ply", "--draw", folder / "m.png"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  REQUIRE(run_program({"edges", pair().left, "--csv", folder / "edges.csv"}).code == 0);
  std::set<std::string> edges;
  for (const auto& row : read_lines(folder / "edges.csv")) edges.insert(row.substr(0, row.rfind(',')));
  const auto rows = read_lines(folder / "matches.csv");
  REQUIRE(rows.size() > 200);
  CHECK(rows[0] == "left_x,left_y,left_direction_rad,right_x,right_y,right_direction_rad,ncc,x_m,y_m,z_m");
  const auto& rig = own_camera::small_dataset().rig;
  std::size_t strangers = 0, points = 0, wrong = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto row = cells(rows[i]);
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
  const std::vector<std::string> match = {"match", pair().left, pair().right, "--max-disparity", "40"};
  auto arguments = match;
  arguments.insert(arguments.end(), {"--csv", folder / "matches.csv"});
  REQUIRE(run_program(arguments).code == 0);
  const auto rows = read_lines(folder / "matches.csv");
  REQUIRE(rows.size() > 200);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto row = cells(rows[i]);
    REQUIRE(row.size() == 10);
    CHECK((row[7].empty() && row[8].empty() && row[9].empty()));
    const double disparity = std::stod(row[0]) - std::stod(row[3]);
    CHECK((disparity > -1 && disparity < 41));
  }
  CHECK(run_program(arguments).code == 2);  // the file exists
  arguments = match;
  arguments.insert(arguments.end(), {"--ply", folder / "points.ply"});
  const auto result = run_program(arguments);
  CHECK(result.code == 2);
  CHECK_THAT(result.err, Contains("--calibration"));
}

TEST_CASE("match: invalid pairs are refused", "[cli]") {
  const TemporaryFolder folder;
  dataset_files::write_image(folder / "small.png");
  dataset_files::write_image(folder / "deep.png", 320, 200, CV_16UC1);
  const std::string calibration = own_camera::write_calibration_of_small(folder / "rig.yaml");
  CHECK(run_program({"match"}).code == 2);
  CHECK(run_program({"match", pair().left}).code == 2);
  auto result = run_program({"match", pair().left, folder / "small.png"});
  CHECK(result.code == 3);
  CHECK_THAT(result.err, Contains("small.png") && Contains("24 rows"));
  result = run_program({"match", pair().left, folder / "deep.png"});
  CHECK(result.code == 3);
  CHECK_THAT(result.err, Contains("deep.png") && Contains("65535"));
  result = run_program({"match", pair().left, folder / "small.png", "--calibration", calibration});
  CHECK(result.code == 3);
  CHECK_THAT(result.err, Contains("small.png") && Contains("32 x 24"));
  CHECK(run_program({"match", pair().left, folder / "absent.png"}).code == 3);
}

TEST_CASE("evaluate matching: says in one line what to run instead", "[cli]") {
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"room", "--frames", "1"}, {"--help"}}) {
    std::vector<std::string> arguments = {"evaluate", "matching"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = run_program(arguments);
    CHECK(result.code == 2);
    CHECK(result.err ==
          "quadedge: the matching is evaluated in Python: run python -m quadedge.matching PATH instead\n");
  }
}
