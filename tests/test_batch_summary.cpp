#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>

#include "dataset_files.hpp"
#include "made_up_run.hpp"
#include "report/batch_summary.hpp"
#include "report/result_rows.hpp"
#include "report/statistics.hpp"
#include "temporary_folder.hpp"

using namespace quadedge;
using dataset_files::write_text;

namespace {

/// Mean and standard deviation over N, by definition.
void check_statistics(const ErrorStatistics& found, const std::vector<double>& values) {
  const double count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double deviations = 0, squares = 0;
  for (const double value : values) deviations += (value - mean) * (value - mean), squares += value * value;
  CHECK(found.mean == Approx(mean).epsilon(1e-10));
  CHECK(found.std == Approx(std::sqrt(deviations / count)).epsilon(1e-6));
  CHECK(found.rmse == Approx(std::sqrt(squares / count)).epsilon(1e-10));
  CHECK(found.max == *std::max_element(values.begin(), values.end()));
}

}  // namespace

TEST_CASE("batch summary: pooled figures are computed over all poses of all sequences", "[report]") {
  const TemporaryFolder folder;
  const auto first = made_up_run(5, 0.01), second = made_up_run(9, 0.003);
  write_member(folder.path(), "one", first);
  write_member(folder.path(), "two", second);
  const auto summary = report::summarise(folder.path(), {"one", "two"}, 50);
  REQUIRE(summary.pooled);
  CHECK(summary.exit_code == 0);
  CHECK(summary.frames == 14);
  CHECK(summary.pooled->matched == 14);
  std::vector<double> ape_rotation, ape_translation, rpe_rotation, rpe_translation, latencies;
  for (const auto* run : {&first, &second}) {
    for (const auto& pose : run->accuracy->per_pose) {
      ape_rotation.push_back(pose.ape_rotation_deg);
      ape_translation.push_back(pose.ape_translation_m);
      if (std::isfinite(pose.rpe_rotation_deg)) rpe_rotation.push_back(pose.rpe_rotation_deg);
      if (std::isfinite(pose.rpe_translation_m)) rpe_translation.push_back(pose.rpe_translation_m);
    }
    for (std::size_t i = 1; i < run->frames.size(); ++i) latencies.push_back(run->frames[i].result.timing.latency_ms);
  }
  REQUIRE(rpe_rotation.size() == 12);
  check_statistics(summary.pooled->origin_aligned.ape_rotation_deg, ape_rotation);
  check_statistics(summary.pooled->origin_aligned.ape_translation_m, ape_translation);
  check_statistics(summary.pooled->origin_aligned.rpe_rotation_deg, rpe_rotation);
  check_statistics(summary.pooled->origin_aligned.rpe_translation_m, rpe_translation);
  CHECK(summary.latency.median == Approx(report::median(latencies)));
  CHECK(summary.latency.first == Approx(10));
  // The average weights both sequences equally, though one has nine poses and the other five.
  CHECK(summary.average->se3_aligned.ape_translation_m.mean ==
        Approx(
            (first.accuracy->se3_aligned.ape_translation_m.mean + second.accuracy->se3_aligned.ape_translation_m.mean) /
            2));
}

TEST_CASE("batch summary: JSON holds every figure unrounded, including failed and missing sequences", "[report]") {
  const TemporaryFolder folder;
  const auto run = made_up_run(6, 0.02);
  write_member(folder.path(), "good", run);
  write_text(report::member_folder(folder.path(), "bad") + "/member.json",
             report::member_json({"bad", "a,\"b\"", "kitti", "", 3, "calib.txt:1: found \"x\", expected\ny", 1}));
  const auto summary = report::summarise(folder.path(), {"bad", "good", "absent"}, 50);
  CHECK(summary.exit_code == 3);
  CHECK(summary.rows[0].status == report::MemberStatus::failed);
  CHECK(summary.rows[2].status == report::MemberStatus::missing);

  const PoseErrors& truth = run.accuracy->origin_aligned;
  const auto json = nlohmann::json::parse(report::summary_json(summary));
  CHECK(json["sequences"][1]["accuracy"]["origin_aligned"]["ape_translation_m"]["mean"] ==
        truth.ape_translation_m.mean);
  CHECK(json["sequences"][1]["accuracy"]["origin_aligned"]["rpe_translation_m"]["std"] == truth.rpe_translation_m.std);
  CHECK(json["sequences"][0]["status"] == "failed");
  CHECK(json["sequences"][0]["path"] == "a,\"b\"");
  CHECK_FALSE(json["sequences"][0].contains("accuracy"));
  CHECK(json["all"]["pooled"]["origin_aligned"]["ape_translation_m"]["mean"].get<double>() ==
        Approx(truth.ape_translation_m.mean));
  CHECK(json["exit_code"] == 3);
}

TEST_CASE("batch summary: the exit code for too few tracked frames ranks between success and bad data", "[report]") {
  const TemporaryFolder folder;
  auto run = made_up_run(10, 0.01);
  for (std::size_t i = 4; i < 10; ++i) run.frames[i].result.status = FrameStatus::lost_no_consensus;
  write_member(folder.path(), "lost", run);
  CHECK(report::summarise(folder.path(), {"lost"}, 40).exit_code == 0);
  CHECK(report::summarise(folder.path(), {"lost"}, 41).exit_code == 5);
  CHECK(report::worse_exit_code(5, 0) == 5);
  CHECK(report::worse_exit_code(5, 3) == 3);
  CHECK(report::worse_exit_code(4, 3) == 4);
  CHECK(report::worse_exit_code(1, 4) == 1);
}

TEST_CASE("frames.csv: a run's rows are read back, whichever frame has the first warning or message", "[report]") {
  const TemporaryFolder folder;
  auto run = made_up_run(3, 0.01);
  const std::string drift = "images, or their calibration, \"drift\"";  // before any frame reached a later stage
  run.frames[0].result.warnings = {{WarningKind::doubtful_calibration, drift}};
  run.frames[0].result.timing.stages = {{"stereo", 4}};
  run.frames[1].result.message = "a \"quoted\", cut\nmessage";
  run.frames[2].result.timing.stages.push_back({"pose", 1.5});
  run.frames[2].result.new_key_rig = true;
  {
    report::AppendFile rows(folder / "frames.csv");
    rows.append(report::frames_row(0, {}).heading());
    for (const auto& frame : run.frames) rows.append(report::frames_row(0, frame.result).line());
  }
  const report::CsvTable table(folder / "frames.csv", "frames");
  CHECK(table.numbers("stamp_s") == std::vector<double>{0, 0.1, 0.2});
  CHECK(table.texts("status") == std::vector<std::string>{"first", "tracked", "tracked"});
  CHECK(table.texts("new_key_rig") == std::vector<std::string>{"0", "0", "1"});
  CHECK(table.numbers("edges_left") == std::vector<double>{100, 101, 102});
  CHECK(table.texts("warning") == std::vector<std::string>{drift, "", ""});
  CHECK(table.texts("message") == std::vector<std::string>{"", "a \"quoted\", cut message", ""});
  CHECK(table.texts("temporal_ms") == std::vector<std::string>{"", "3.000", "3.000"});
  CHECK(std::isnan(table.numbers("pose_ms")[0]));
  CHECK(table.numbers("pose_ms")[2] == 1.5);
  CHECK_THROWS_WITH(table.texts("colour"), Catch::Matchers::Contains("no column colour"));
  write_text(folder / "cut.csv", "a,b\n1,2\n3\n");
  CHECK_THROWS_WITH(report::CsvTable(folder / "cut.csv", "frames"),
                    Catch::Matchers::Contains("cut.csv:3: found 1 field"));
}
