#include <nlohmann/json.hpp>

#include "program.hpp"

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

/// A map of the small sequence, made by the program.
struct SharedMap {
  TemporaryFolder folder;
  ProgramResult result = run_program({"run", small_sequence(), "-o", folder / "out", "--save-map", folder / "room.map",
                                      "--odometry.key_max_frames", "1", "--quiet"});
  std::string file() const { return folder / "room.map"; }
};
const SharedMap& shared_map() {
  static const SharedMap map;
  return map;
}

}  // namespace

TEST_CASE("localise: the frames of a map are found in it", "[cli][device]") {
  const SharedMap& map = shared_map();
  INFO(map.result.err);
  REQUIRE(map.result.code == 0);
  CHECK(fs::exists(map.folder / "out/trajectory_map.txt"));  // --save-map implies --loops
  for (const bool follow : {false, true}) {
    const TemporaryFolder folder;
    const Words arguments = Words{"localise", map.file(), small_sequence(), "-o", folder / "out", "--quiet"} +
                            (follow ? Words{"--follow"} : Words());
    CHECK_THAT(run_well(arguments).out, Contains("located    4 of 4 frames") && Contains("SE(3)-aligned"));
    CHECK(read_lines(folder / "out/trajectory.txt").size() == 5);
    const auto rows = read_lines(folder / "out/locations.csv");
    REQUIRE(rows.size() == 5);
    CHECK_THAT(rows[0], Contains("frame,stamp_s,status,key_rig,followed,inliers,support,x,y,z,qx,qy,qz,qw"));
    CHECK_THAT(rows[4], Contains(follow ? ",located,0,1," : ",located,0,0,"));
    const auto json = nlohmann::json::parse(read_text(folder / "out/localisation.json"));
    CHECK(json.at("frames_located") == 4);
    CHECK(json.at("map").at("key_rigs") == 1);  // the four frames see the same
    CHECK(json.at("accuracy").at("se3_aligned").at("ape_translation_m").at("max") < 0.005);
    check_error(arguments, 2);  // results are kept
  }
}

TEST_CASE("localise: errors have the documented exit codes", "[cli][device]") {
  const SharedMap& map = shared_map();
  REQUIRE(map.result.code == 0);
  const TemporaryFolder folder;
  const auto refused = [&](const Words& arguments, int code, const std::string& words) {
    check_error(Words{"localise"} + arguments + Words{"-o", folder / "out", "--quiet"}, code, {words});
  };
  refused({small_sequence() + "/absent.map", small_sequence()}, 3, "absent.map");
  refused({map.folder / "out/report.json", small_sequence()}, 3, "report.json: found a file of another kind");
  refused({map.file(), folder / "absent"}, 3, "absent");
  refused({map.file()}, 2, "PATH");
  refused({map.file(), small_sequence(), "--edges.sigma", "3"}, 2, "edges.sigma = 2");
  refused({map.file(), small_sequence(), "--min-tracked", "101"}, 2, "--min-tracked");
  refused({map.file(), small_sequence(), "--frames", "3"}, 2, "--frames 3");
  CHECK_FALSE(fs::exists(folder / "out/locations.csv"));
  // Another scene: nothing is found.
  run_well({"synth", folder / "cables", "--scene", "cables", "--frames", "2", "--size", "320x200", "--quiet"});
  refused({map.file(), folder / "cables"}, 5, "located 0 of 2 frames");
}

TEST_CASE("run: a map that cannot be written or exists is refused before the run", "[cli][device]") {
  const TemporaryFolder folder;
  check_error({"run", small_sequence(), "-o", folder / "a", "--save-map", folder / "absent/a.map"}, 3,
              {"absent/a.map"});
  CHECK_FALSE(fs::exists(folder / "a/trajectory.txt"));
  check_error({"run", small_sequence(), "-o", folder / "b", "--save-map", shared_map().file()}, 2, {"--force"});
}
