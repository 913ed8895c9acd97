#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "damaged_sequence.hpp"
#include "program.hpp"

using Catch::Matchers::Contains;

namespace {

void blacken(const DamagedSequence& sequence, std::size_t frame) {
  for (const char* camera : {"rgb", "rgb2"}) {
    cv::imwrite(sequence.image(camera, frame).string(), cv::Mat::zeros(200, 320, CV_8UC1));
  }
}

/// A column of a CSV file.
std::vector<std::string> column(const std::string& path, int number) {
  std::vector<std::string> result;
  std::ifstream stream(path);
  std::string row, field;
  std::getline(stream, row);
  while (std::getline(stream, row)) {
    std::istringstream fields(row);
    for (int i = 0; i <= number; ++i) std::getline(fields, field, ',');
    result.push_back(field);
  }
  return result;
}

/// Status of every frame in frames.csv.
std::vector<std::string> statuses(const std::string& path) { return column(path, 2); }

/// Positions of the left camera in a KITTI file.
std::vector<std::array<double, 3>> positions(const std::string& path) {
  std::vector<std::array<double, 3>> result;
  std::ifstream stream(path);
  for (std::array<double, 12> row; true;) {
    for (auto& value : row) stream >> value;
    if (!stream) return result;
    result.push_back({row[3], row[7], row[11]});
  }
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

TEST_CASE("run: a black frame is lost, and tracking resumes after it", "[cli][device]") {
  const DamagedSequence sequence;
  blacken(sequence, 1);
  const TemporaryFolder folder;
  const auto result = run_program({"run", sequence.path(), "-o", folder / "out"});
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK_THAT(result.out, Contains("3 of 4 frames"));
  const auto status = statuses(folder / "out/frames.csv");
  REQUIRE(status.size() == 4);
  CHECK(status[0] == "first");
  CHECK(status[1] == "lost_too_few_edges");
  CHECK(status[2] == "tracked");
  CHECK(status[3] == "tracked");
  CHECK(positions(folder / "out/trajectory_kitti.txt").size() == 4);
  const auto whole = run_program({"run", small_sequence(), "-o", folder / "whole"});
  REQUIRE(whole.code == 0);
  const auto here = positions(folder / "out/trajectory_kitti.txt"),
             there = positions(folder / "whole/trajectory_kitti.txt");
  CHECK(distance(here[3], there[3]) < 0.05 * distance(there[0], there[3]));
}

TEST_CASE("run, evaluate: an unknown motion divides the trajectory into segments", "[cli][device]") {
  // Black images, then another scene: its first frame is lost, the next one is located against it.
  const TemporaryFolder folder;
  for (const std::string scene : {"room", "cables"}) {
    REQUIRE(run_program({"synth", folder / scene, "--scene", scene, "--frames", "6", "--size", "320x200", "--quiet"})
                .code == 0);
  }
  for (const std::string camera : {"/rgb", "/rgb2"}) {
    const auto images = [&](const std::string& scene) {
      std::vector<std::string> files;
      for (const auto& entry : std::filesystem::directory_iterator((folder / scene) + camera))
        files.push_back(entry.path().string());
      std::sort(files.begin(), files.end());
      return files;
    };
    const auto room = images("room"), cables = images("cables");
    cv::imwrite(room[2], cv::Mat::zeros(200, 320, CV_8UC1));
    for (const std::size_t i : {3, 4, 5})
      std::filesystem::copy_file(cables[i], room[i], std::filesystem::copy_options::overwrite_existing);
  }
  const auto run = run_program({"run", folder / "room", "-o", folder / "out", "--stereo.max_disparity", "60"});
  INFO(run.err);
  REQUIRE(run.code == 0);
  CHECK(column(folder / "out/frames.csv", 3) == std::vector<std::string>{"0", "0", "0", "0", "1", "1"});
  CHECK_THAT(run.err, Contains("warning: frame 4: the motion between frames 1 and 4 is unknown"));
  CHECK_THAT(run.out, Contains("broken     2 segments: an unknown motion lies between frames 1 and 4"));
  const auto report = nlohmann::json::parse(read_text(folder / "out/report.json"));
  CHECK(report["segments"] == 2);
  CHECK(report["segments_text"] == "2 segments: an unknown motion lies between frames 1 and 4");
  CHECK(report["warnings"][0]["kind"] == "unknown_motion");
  CHECK(report["accuracy"]["matched_poses"] == 4);
  CHECK(report["accuracy"]["rpe_steps"] == 2);
  REQUIRE(report["accuracy"]["segments"].size() == 2);
  CHECK(report["accuracy"]["segments"][1]["segment"] == 1);
  const auto rows = read_lines(folder / "out/trajectory.txt");
  REQUIRE(rows.size() == 6);
  CHECK(rows[3] == "# segment 1: the motion since the poses above is unknown");
  const auto errors = column(folder / "out/errors.csv", 3);
  REQUIRE(errors.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) CHECK(errors[i].empty() == (i % 2 == 0));

  for (const std::string estimate : {"out", "out/trajectory.txt"}) {
    const auto evaluated = run_program(
        {"evaluate", "trajectory", folder / estimate, folder / "room", "--json", folder / (estimate + ".json")});
    INFO(evaluated.err);
    REQUIRE(evaluated.code == 0);
    const auto json = nlohmann::json::parse(read_text(folder / (estimate + ".json")));
    REQUIRE(json["accuracy"]["segments"].size() == 2);
    CHECK_THAT(evaluated.out, Contains("segments, each aligned by itself"));
    for (std::size_t i = 0; i < 2; ++i) {
      const auto drift = [&](const nlohmann::json& from) {
        return from["accuracy"]["segments"][i]["end_drift_percent"].get<double>();
      };
      CHECK(drift(json) == Approx(drift(report)).epsilon(1e-6));
    }
  }
}

TEST_CASE("run: with too few tracked frames it ends with code 5 after writing everything", "[cli][device]") {
  const DamagedSequence sequence;
  for (const std::size_t frame : {1, 2, 3}) blacken(sequence, frame);
  const TemporaryFolder folder;
  const auto result = run_program({"run", sequence.path(), "-o", folder / "out"});
  CHECK(result.code == 5);
  CHECK_THAT(result.err, Contains("1 of 4 frames") && Contains("--min-tracked"));
  CHECK_THAT(read_text(folder / "out/report.json"), Contains("\"frames_lost\": 3"));
  CHECK(run_program({"run", sequence.path(), "-o", folder / "out", "--force", "--min-tracked", "25"}).code == 0);
}

TEST_CASE("run: --quiet keeps warnings, reasons for lost frames and the cause of the exit code", "[cli][device]") {
  const DamagedSequence sequence;
  for (const std::size_t frame : {1, 2, 3}) blacken(sequence, frame);
  const TemporaryFolder folder;
  const auto loud = run_program({"run", sequence.path(), "-o", folder / "loud"});
  const auto quiet = run_program({"run", sequence.path(), "-o", folder / "quiet", "--quiet"});
  CHECK(loud.code == 5);
  CHECK(quiet.code == 5);
  CHECK_THAT(loud.err, Contains("frame 4/4"));
  CHECK_THAT(quiet.err, !Contains("frame 4/4") && !Contains("kernels"));
  for (const auto& err : {loud.err, quiet.err}) {
    CHECK_THAT(err, Contains("warning: frame 1: lost: 0 stereo edges") && !Contains("frame 2: lost"));
    CHECK_THAT(err, Contains("tracked 1 of 4 frames") && Contains("lost: 3 too few edges"));
  }
  for (const auto& out : {loud.out, quiet.out}) CHECK_THAT(out, Contains("lost       3 too few edges"));
}

TEST_CASE("run: the same frame twice gives no motion", "[cli][device]") {
  const DamagedSequence sequence;
  for (const char* camera : {"rgb", "rgb2"}) {
    std::filesystem::copy_file(sequence.image(camera, 0), sequence.image(camera, 1),
                               std::filesystem::copy_options::overwrite_existing);
  }
  const TemporaryFolder folder;
  const auto result = run_program({"run", sequence.path(), "-o", folder / "out", "--frames", "0:2"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(statuses(folder / "out/frames.csv") == std::vector<std::string>{"first", "tracked"});
  const auto position = positions(folder / "out/trajectory_kitti.txt");
  REQUIRE(position.size() == 2);
  CHECK(distance(position[0], position[1]) < 1e-5);
}

TEST_CASE("edges: a kernel that does not build ends with code 4 and names its file and line", "[cli][device]") {
  const TemporaryFolder folder;
  std::filesystem::copy(QUADEDGE_KERNELS, folder / "kernels");
  std::ofstream(folder / "kernels/common.cl") << "int broken(int a) {\n  return undeclared;\n}\n";
  const DamagedSequence sequence;
  const auto result = run_program({"edges", sequence.image("rgb", 0).string(), "--kernels", folder / "kernels"});
  CHECK(result.code == 4);
  CHECK_THAT(result.err, Contains("common.cl:2"));
  std::filesystem::remove(folder / "kernels/common.cl");
  const auto missing = run_program({"edges", sequence.image("rgb", 0).string(), "--kernels", folder / "kernels"});
  CHECK(missing.code == 3);
  CHECK_THAT(missing.err, Contains("common.cl"));
}
