#include <nlohmann/json.hpp>

#include "csv_table.hpp"
#include "dataset_files.hpp"
#include "program.hpp"

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

/// A run of the small sequence, shared by the tests that only read its files.
struct SharedRun {
  TemporaryFolder folder;
  ProgramResult result = run_program({"run", small_sequence(), "-o", folder / "out", "--draw", "2"});
  std::string out(const std::string& name) const { return folder / ("out/" + name); }
};
const SharedRun& shared_run() {
  static const SharedRun run;
  return run;
}

}  // namespace

TEST_CASE("run: writes every documented file", "[cli][device]") {
  const auto& run = shared_run();
  INFO(run.result.err);
  REQUIRE(run.result.code == 0);
  for (const char* name : {"trajectory.txt", "trajectory_kitti.txt", "frames.csv", "poses.csv", "report.json",
                           "config.toml", "edges.csv", "pictures/edges_000000.png", "pictures/quads_000002.png"}) {
    INFO(name);
    CHECK(fs::file_size(run.out(name)) > 0);
  }
  CHECK_FALSE(fs::exists(run.out("pictures/edges_000001.png")));
}

TEST_CASE("run: the summary has the path length, the mean error and the next command, in ten lines", "[cli][device]") {
  const TemporaryFolder folder;
  const auto result = run_well({"run", small_sequence(), "-o", folder / "my results"});
  CHECK(std::count(result.out.begin(), result.out.end(), '\n') <= 10);
  CHECK_THAT(result.out, Contains("results    " + (folder / "my results/trajectory.txt")));
  const std::string program = result.out.substr(result.out.find("next       ") + 11);
  CHECK(program.substr(0, program.find(' ')) == program_path());
  CHECK_THAT(program, Contains(" report '" + (folder / "my results") + "'"));
  const auto report = nlohmann::json::parse(read_text(folder / "my results/report.json"));
  char error[48];
  std::snprintf(error, sizeof error, "error      %.3g mm and ",
                1e3 * report["accuracy"]["origin_aligned"]["rpe_translation_m"]["mean"].get<double>());
  CHECK_THAT(result.out, Contains(error));
  std::istringstream rows(read_text(folder / "my results/trajectory.txt"));
  double length = 0;
  std::array<double, 8> pose{}, before{};
  std::string heading;
  std::getline(rows, heading);
  for (int i = 0; i < 4; ++i, before = pose) {
    for (auto& value : pose) REQUIRE(rows >> value);
    if (i > 0) length += std::hypot(pose[1] - before[1], pose[2] - before[2], pose[3] - before[3]);
  }
  REQUIRE(length > 0);
  char text[48];
  std::snprintf(text, sizeof text, "path       %.3f m", length);
  CHECK_THAT(result.out, Contains(text));
}

TEST_CASE("run: poses.csv has the pose of every frame with both covariances", "[cli][device]") {
  const auto rows = read_lines(shared_run().out("poses.csv"));
  REQUIRE(rows.size() == 5);
  const auto names = csv_fields(rows[0]);
  REQUIRE(names.size() == 5 + 7 + 7 + 21 + 21 + 1);
  CHECK(names[19] == "covariance_x_x");
  CHECK(names[40] == "reference_covariance_x_x");
  CHECK(names[60] == "reference_covariance_rz_rz");
  CHECK(names[61] == "base_frame");
  const auto tum = read_lines(shared_run().out("trajectory.txt"));
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto values = csv_fields(rows[i]);
    REQUIRE(values.size() == names.size());
    std::istringstream pose(tum[i]);
    std::string value;
    pose >> value;
    CHECK(value == values[1]);
    for (std::size_t column = 5; column < 12 && pose >> value; ++column) CHECK(value == values[column]);
    // A covariance valid for ROS has variances on the diagonal; the first pose is exact by definition.
    for (const std::size_t first : {19, 40}) {
      std::size_t column = first;
      for (std::size_t length = 6; length > 0; column += length--) {
        const double variance = std::stod(values[column]);
        CHECK((i == 1 ? variance == 0 : variance > 0));
      }
    }
  }
}

TEST_CASE("run: the report has every documented key", "[cli][device]") {
  const auto& run = shared_run();
  const auto report = nlohmann::json::parse(read_text(run.out("report.json")));
  for (const char* key : {"schema", "version", "device", "variants", "input", "frames_tracked", "latency_ms",
                          "stages_ms", "start_ms", "memory_mb", "counts", "accuracy"}) {
    INFO(key);
    CHECK(report.contains(key));
  }
  CHECK(report["frames_tracked"] == 4);
  CHECK(report["input"]["frames"] == 4);
  CHECK(report["input"]["width"] == 320);
  CHECK(report["input"]["format"] == "eth3d-slam");
  for (const char* key : {"median", "p90", "p99", "max", "first"}) CHECK(report["latency_ms"][key].get<double>() > 0);
  CHECK(report["latency_ms"]["max"] >= report["latency_ms"]["median"]);
  for (const char* key : {"name", "driver", "opencl", "type"}) CHECK(report["device"].contains(key));
  for (const char* key : {"host_peak", "device_peak"}) CHECK(report["memory_mb"][key].get<double>() > 1);
  CHECK(report["start_ms"]["total"] >= report["start_ms"]["kernel_build"]);
  CHECK(report["counts"]["edges_left"].get<double>() > 100);
  for (const char* alignment : {"origin_aligned", "se3_aligned"}) {
    for (const char* error : {"ape_rotation_deg", "ape_translation_m", "rpe_rotation_deg", "rpe_translation_m"}) {
      for (const char* number : {"mean", "std", "rmse", "max"}) {
        // An alignment of four nearly collinear positions leaves the rotation undetermined: null.
        const bool may_be_null = std::string(alignment) == "se3_aligned" && std::string(error) == "ape_rotation_deg";
        CHECK((report["accuracy"][alignment][error][number].is_number() || may_be_null));
      }
    }
  }
  // The short run has fewer than five motions over one frame.
  CHECK_FALSE(report["accuracy"].contains("consistency"));
  CHECK(report["stages_ms"].size() > 2);
}

TEST_CASE("run: frames.csv has a row per frame whose stage times add up to the latency", "[cli][device]") {
  const auto& run = shared_run();
  const auto rows = read_lines(run.out("frames.csv"));
  REQUIRE(rows.size() == 5);
  const auto names = csv_fields(rows[0]);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto values = csv_fields(rows[i]);
    REQUIRE(values.size() == names.size());
    double latency = 0, stages = 0;
    for (std::size_t column = 0; column < names.size(); ++column) {
      if (names[column] == "latency_ms")
        latency = std::stod(values[column]);
      else if (names[column].size() > 3 && names[column].rfind("_ms") == names[column].size() - 3 &&
               !values[column].empty()) {
        stages += std::stod(values[column]);
      }
    }
    CHECK(latency > 0);
    CHECK(stages > 0.5 * latency);
    CHECK(stages < 1.02 * latency + 0.1);
  }
}

TEST_CASE("run: results are not replaced without --force", "[cli][device]") {
  const TemporaryFolder folder;
  fs::create_directories(folder / "out/pictures");
  std::ofstream(folder / "out/report.json") << "precious";
  std::ofstream(folder / "out/pictures/quads_000077.png") << "stale";
  std::ofstream(folder / "out/notes.txt") << "the user's own";
  check_error({"run", small_sequence(), "-o", folder / "out"}, 2, {"--force", folder / "out"});
  CHECK(read_text(folder / "out/report.json") == "precious");
  run_well({"run", small_sequence(), "-o", folder / "out", "--force", "--frames", "0:2"});
  CHECK_THAT(read_text(folder / "out/report.json"), Contains("frames_tracked"));
  CHECK_FALSE(fs::exists(folder / "out/pictures/quads_000077.png"));
  CHECK(read_text(folder / "out/notes.txt") == "the user's own");
}

TEST_CASE("run: no OpenCL device ends with code 4 and installation help", "[cli]") {
  const TemporaryFolder folder;
  const std::string no_vendors = "OCL_ICD_VENDORS='" + folder.path() + "/'";
  const Words run = {"run", small_sequence(), "-o", folder / "out"};
  check_error(run, 4,
              {"pocl-opencl-icd", "--device reference", "OCL_ICD_VENDORS=" + folder.path(), "holds no .icd file"},
              no_vendors);
  write_text(folder / "a.icd", "libno_such_driver.so.7\n");
  check_error(run, 4, {folder / "a.icd", "libno_such_driver.so.7"}, no_vendors);
  check_error(run, 4, {"/nowhere/b.icd", "does not exist"}, "OCL_ICD_VENDORS=/nowhere/b.icd");
  CHECK_THAT(run_well({"devices"}, no_vendors).out, Contains("reference") && Contains("pocl-opencl-icd"));
}

TEST_CASE("run: ground truth for half of the frames is used for that half and reported", "[cli][device]") {
  const TemporaryFolder folder;
  fs::copy(small_sequence(), folder / "room", fs::copy_options::recursive);
  const auto truth = read_lines(folder / "room/groundtruth.txt");
  std::ofstream half(folder / "room/groundtruth.txt");
  std::size_t data = 0;
  for (const auto& line : truth) {
    if (line.empty() || line[0] == '#') continue;
    if (++data <= 2) half << line << "\n";
  }
  half.close();
  REQUIRE(data == 4);
  CHECK_THAT(run_well({"run", folder / "room", "-o", folder / "out"}).err, Contains("2 of 4"));
  const auto report = nlohmann::json::parse(read_text(folder / "out/report.json"));
  CHECK(report["accuracy"]["matched_poses"] == 2);
  CHECK_THAT(run_well({"check", folder / "room"}).out, Contains("warning"));
}

TEST_CASE("run: a device that fails in mid-run costs no finished frame and no file", "[cli][device]") {
  const TemporaryFolder folder;
  const auto launches = [&](long most) {
    return "LD_PRELOAD='" QUADEDGE_LOST_DEVICE "' QUADEDGE_TEST_LAUNCHES=" + std::to_string(most);
  };
  const auto run = [&](long most) {
    return run_program({"run", small_sequence(), "-o", folder / "out", "--force", "--loops", "--save-map",
                        folder / "places.map", "--points", folder / "edges.ply", "--quiet"},
                       launches(most));
  };
  REQUIRE(shared_run().result.code == 0);  // the verdict of the self-test is kept
  CHECK(run(10).code == 4);                // before the first frame
  CHECK_FALSE(fs::exists(folder / "out/report.json"));
  CHECK_FALSE(fs::exists(folder / "places.map"));
  ProgramResult result;
  for (long most = 60; read_lines(folder / "out/trajectory_kitti.txt").size() < 2; most += 10) {
    REQUIRE(most < 1000);
    result = run(most);
  }
  CHECK(result.code == 4);
  CHECK_THAT(result.err, Contains("finished frames in") && Contains("CL_OUT_OF_RESOURCES"));
  const auto report = nlohmann::json::parse(read_text(folder / "out/report.json"));
  CHECK(report["input"]["frames"] == 4);
  CHECK_THAT(report["ended_early"].get<std::string>(), Contains("CL_OUT_OF_RESOURCES"));
  CHECK(report["accuracy"]["matched_poses"] == read_lines(folder / "out/trajectory_kitti.txt").size());
  for (const char* file : {"places.map", "edges.ply", "out/trajectory_map.txt", "out/errors.csv"}) {
    INFO(file);
    CHECK(fs::file_size(folder / file) > 0);
  }
}
