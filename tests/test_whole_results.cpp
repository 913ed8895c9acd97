#include <catch2/catch.hpp>
#include <filesystem>

#include "dataset_files.hpp"
#include "made_up_run.hpp"
#include "quadedge/error.hpp"
#include "report/batch_summary.hpp"
#include "report/result_rows.hpp"
#include "temporary_folder.hpp"

using namespace quadedge;
using namespace dataset_files;
using Catch::Matchers::Contains;

TEST_CASE("whole results: every truncated, damaged or missing file is named", "[report]") {
  const TemporaryFolder folder;
  const auto run = made_up_run(6, 0.01);
  write_member(folder.path(), "run", run);
  const std::string place = report::member_folder(folder.path(), "run");
  Trajectory poses;
  for (const auto& frame : run.frames) poses.push_back({frame.result.stamp_ns, *frame.result.world_from_left});
  write_kitti(place + "/trajectory_kitti.txt", poses);
  write_text(place + "/errors.csv", report::errors_csv(*run.accuracy));
  write_text(place + "/config.toml", "seed = 42\n");
  {
    report::AppendFile rows(place + "/poses.csv");
    rows.append(report::poses_row(0, {}).heading());
    for (const auto& frame : run.frames) rows.append(report::poses_row(0, frame.result).line());
  }
  REQUIRE_NOTHROW(report::check_whole(place));
  const auto check = [&](const std::string& name, const std::string& text) {
    INFO(name << ": " << text.size() << " bytes");
    const std::string good = read_text(place + "/" + name);
    write_text(place + "/" + name, text);
    CHECK_THROWS_AS(report::check_whole(place), DataError);
    CHECK_THROWS_WITH(report::check_whole(place), Contains(name));
    write_text(place + "/" + name, good);
    CHECK_NOTHROW(report::check_whole(place));
  };
  for (const char* name : {"report.json", "frames.csv", "poses.csv", "trajectory.txt", "trajectory_kitti.txt",
                           "groundtruth.txt", "errors.csv", "config.toml"}) {
    const std::string good = read_text(place + "/" + name);
    const bool is_report = name == std::string("report.json");
    check(name, "");
    check(name, good.substr(0, good.size() - (is_report ? 3 : 1)));
    check(name, good.substr(0, good.size() / 2));
    const std::size_t last_line = good.rfind('\n', good.size() - 2) + 1;
    const bool has_rows = name != std::string("config.toml") && name != std::string("groundtruth.txt");
    if (has_rows) check(name, good.substr(0, last_line));
  }
  for (const char* name : {"report.json", "frames.csv", "poses.csv", "trajectory.txt", "config.toml", "errors.csv"}) {
    INFO(name);
    std::filesystem::rename(place + "/" + name, folder / "aside");
    CHECK_THROWS_WITH(report::check_whole(place), Contains(name));
    std::filesystem::rename(folder / "aside", place + "/" + name);
  }
}
