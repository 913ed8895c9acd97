#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "csv_table.hpp"
#include "damaged_sequence.hpp"

using Catch::Matchers::Contains;

namespace {

void blacken(const DamagedSequence& sequence, std::size_t frame) {
  for (const char* camera : {"rgb", "rgb2"}) {
    cv::imwrite(sequence.image(camera, frame).string(), cv::Mat::zeros(200, 320, CV_8UC1));
  }
}

}  // namespace

TEST_CASE("run, evaluate: an unknown motion divides the trajectory into segments", "[cli][device]") {
  // Black images, then another scene: its first frame is lost, the next one is located against it.
  const TemporaryFolder folder;
  for (const std::string scene : {"room", "cables"})
    run_well({"synth", folder / scene, "--scene", scene, "--frames", "6", "--size", "320x200", "--quiet"});
  for (const std::string camera : {"/rgb", "/rgb2"}) {
    const auto images = [&](const std::string& scene) {
      Words files;
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
  const auto run = run_well({"run", folder / "room", "-o", folder / "out", "--stereo.max_disparity", "60"});
  CHECK(csv_column(folder / "out/frames.csv", "segment") == Words{"0", "0", "0", "0", "1", "1"});
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
  const auto errors = csv_column(folder / "out/errors.csv", "rpe_rotation_deg");
  REQUIRE(errors.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) CHECK(errors[i].empty() == (i % 2 == 0));

  for (const std::string estimate : {"out", "out/trajectory.txt"}) {
    const auto evaluated = run_well(
        {"evaluate", "trajectory", folder / estimate, folder / "room", "--json", folder / (estimate + ".json")});
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

TEST_CASE("run: with too few tracked frames it ends with code 5 after writing everything; --quiet keeps the reasons",
          "[cli][device]") {
  const DamagedSequence sequence;
  for (const std::size_t frame : {1, 2, 3}) blacken(sequence, frame);
  const TemporaryFolder folder;
  const auto loud = check_error({"run", sequence.path(), "-o", folder / "loud"}, 5, {"--min-tracked", "frame 4/4"});
  const auto quiet = check_error({"run", sequence.path(), "-o", folder / "quiet", "--quiet"}, 5);
  CHECK_THAT(read_text(folder / "loud/report.json"), Contains("\"frames_lost\": 3"));
  CHECK_THAT(quiet.err, !Contains("frame 4/4") && !Contains("kernels"));
  for (const auto& err : {loud.err, quiet.err}) {
    CHECK_THAT(err, Contains("warning: frame 1: lost: 0 stereo edges") && !Contains("frame 2: lost"));
    CHECK_THAT(err, Contains("tracked 1 of 4 frames") && Contains("lost: 3 too few edges"));
  }
  for (const auto& out : {loud.out, quiet.out}) CHECK_THAT(out, Contains("lost       3 too few edges"));
  run_well({"run", sequence.path(), "-o", folder / "loud", "--force", "--min-tracked", "25"});
}
