#include <nlohmann/json.hpp>

#include "benchmark/bench_record.hpp"
#include "benchmark/latency.hpp"
#include "frontends.hpp"
#include "output/json.hpp"
#include "program.hpp"

using Catch::Matchers::Contains;
using Json = nlohmann::json;
using namespace quadedge;

namespace {

/// A small benchmark, shared by the tests that read its files.
struct SharedBench {
  TemporaryFolder folder;
  ProgramResult result = run_program({"bench", "--size", "160x100", "--edges", "1500", "--frames", "2", "--warm-up",
                                      "3", "--baseline", "--json", folder / "bench.json", "--quiet"});
  Json parsed() const { return Json::parse(read_text(folder / "bench.json")); }
};
const SharedBench& shared_bench() {
  static const SharedBench bench;
  return bench;
}

void write(const std::string& path, const Json& value) { std::ofstream(path) << value; }

/// Exit code and output of comparing the shared result with a changed copy of it.
ProgramResult compare_with(const Json& changed, const Words& more = {}) {
  const TemporaryFolder folder;
  write(folder / "new.json", changed);
  return run_program(Words{"bench", "--compare", shared_bench().folder / "bench.json", folder / "new.json"} + more);
}

}  // namespace

// LONG: the list of all fields.
TEST_CASE("bench: the JSON has every field", "[cli][device]") {
  const auto& bench = shared_bench();
  INFO(bench.result.err);
  REQUIRE(bench.result.code == 0);
  const Json result = bench.parsed();
  const std::map<std::string, Words> fields = {
      {"",
       {"schema", "bench_schema", "version", "commit", "command", "frames_measured", "frames_tracked", "frames_lost",
        "warm_up", "threads", "edges_wanted", "waits_per_frame", "launches_per_frame", "writes_per_frame"}},
      {"/device", {"name", "driver", "platform", "opencl"}},
      {"/variants", {"edge_detection"}},
      {"/input", {"width"}},
      {"/latency_ms", {"median", "p90", "p99", "max", "first"}},
      {"/edge_detection_ms", {"median", "p90"}},
      {"/stages_ms/stereo", {"median"}},
      {"/kernels_ms/edge_detection", {"median"}},
      {"/kernels_ms/temporal_match", {"p90"}},
      {"/start_ms", {"total", "kernel_build"}},
      {"/memory_mb", {"host_peak", "device_peak", "frames"}},
      {"/moved_mb_per_frame", {"to_device", "to_host"}},
      {"/processor_ms", {"median"}},
      {"/shares/host", {"percent"}},
      {"/shares/stages/point_index", {"wall_ms"}},
      {"/shares/stages/scan", {"launches"}},
      {"/counts", {"edges_left"}},
      {"/config/edges", {"threshold"}},
      {"/baseline", {"opencv_sift_both_ms", "opencv_sepfilter_nine_ms", "threads", "frame_ratio", "edges_ratio"}},
  };
  for (const auto& [place, names] : fields) {
    for (const auto& name : names) {
      CAPTURE(place, name);
      CHECK(result.contains(Json::json_pointer(place + "/" + name)));
    }
  }
  CHECK(result["frames_measured"] == 2);
  CHECK(result["warm_up"] == 3);  // so that no frame is measured that is always searched for a second motion
  CHECK(result["input"]["frames"] == 6);
  CHECK(result["frames_tracked"] == 3);
  CHECK(result["edges_wanted"] == 1500);
  CHECK(result["counts"]["edges_left"].get<double>() ==
        Approx(1500).epsilon(0.05));  // chosen on the first frame, for both images together
  CHECK_THAT(result["command"].get<std::string>(), Contains("quadedge bench --size 160x100"));
  // At least both images are uploaded, with one byte per pixel.
  CHECK(result["moved_mb_per_frame"]["to_device"].get<double>() > 2 * 160 * 100 / (1024.0 * 1024.0));
  // The numbers of edges and candidates, the stereo edges, and the results of at most two searches.
  CHECK(result["waits_per_frame"].get<double>() >= 4);
  CHECK(result["waits_per_frame"].get<double>() <= 5);
  CHECK(result["launches_per_frame"].get<double>() > 20);
  CHECK(result["processor_ms"]["median"].get<double>() > 0);
  double percent = result["shares"]["host"]["percent"].get<double>();
  CHECK(percent > 0);
  for (const auto& stage : result["shares"]["stages"]) {
    percent += stage["percent"].get<double>();
    CHECK(stage["wall_ms"].get<double>() ==
          Approx(stage["kernel_ms"].get<double>() + stage["transfer_ms"].get<double>() +
                 stage["queue_ms"].get<double>()));
  }
  CHECK(percent == Approx(100));
  CHECK(result["memory_mb"]["frames"].get<double>() == Approx(6 * 2 * 160 * 100 / (1024.0 * 1024.0)));
  CHECK(result["baseline"]["frame_ratio"].get<double>() ==
        Approx(result["latency_ms"]["median"].get<double>() / result["baseline"]["opencv_sift_both_ms"].get<double>()));
  CHECK(result["baseline"]["edges_ratio"].get<double>() ==
        Approx(result["edge_detection_ms"]["median"].get<double>() /
               result["baseline"]["opencv_sepfilter_nine_ms"].get<double>()));
  CHECK_THAT(bench.result.out, Contains("kernel build") && Contains("frame / S") && Contains("(chosen)"));
}

TEST_CASE("bench: a comparison ends with 0 for equal results and within the noise band, with 6 beyond it",
          "[cli][device]") {
  const Json before = shared_bench().parsed();
  const auto same = compare_with(before);
  INFO(same.err);
  CHECK(same.code == 0);
  CHECK_THAT(same.out, Contains("no regression"));

  Json slower = before;
  slower["latency_ms"]["median"] = 1.2 * before["latency_ms"]["median"].get<double>();
  const auto beyond = compare_with(slower);
  CHECK(beyond.code == bench::kRegressionExitCode);
  CHECK(beyond.code == 6);
  CHECK_THAT(beyond.out, Contains("WORSE") && Contains("REGRESSION") && Contains("+20.0 %"));
  CHECK(compare_with(slower, {"--noise", "25"}).code == 0);

  Json faster = before;
  faster["latency_ms"]["median"] = 0.5 * before["latency_ms"]["median"].get<double>();
  CHECK(compare_with(faster).code == 0);

  // All times and the baseline are 1.5 times as long: the machine was slower, not the program.
  Json slow_machine = before;
  for (const char* table : {"latency_ms", "edge_detection_ms"}) {
    for (auto& value : slow_machine[table]) value = 1.5 * value.get<double>();
  }
  for (const char* table : {"stages_ms", "kernels_ms"}) {
    for (auto& stage : slow_machine[table]) stage["median"] = 1.5 * stage["median"].get<double>();
  }
  CHECK(compare_with(slow_machine).code == 6);
  slow_machine["baseline"]["opencv_sift_both_ms"] = 1.5 * before["baseline"]["opencv_sift_both_ms"].get<double>();
  CHECK(compare_with(slow_machine).code == 0);

  Json bare = before;
  bare.erase("baseline");
  CHECK_THAT(compare_with(bare).out, Contains("--baseline"));

  Json memory = before;
  memory["memory_mb"]["device_peak"] = 1.2 * before["memory_mb"]["device_peak"].get<double>();
  CHECK(compare_with(memory).code == 6);

  Json lost = before;
  lost["frames_lost"] = before["frames_lost"].get<int>() + 1;
  CHECK(compare_with(lost).code == 6);

  Json changed = before;
  changed["variants"]["edge_detection"] = "another";
  const auto noted = compare_with(changed);
  CHECK(noted.code == 0);
  CHECK_THAT(noted.out, Contains("variants/edge_detection") && Contains("another"));
}

TEST_CASE("bench: results that cannot be compared are refused by name", "[cli][device]") {
  Json other_device = shared_bench().parsed();
  other_device["device"]["name"] = "another device";
  auto result = compare_with(other_device);
  CHECK(result.code == 3);
  CHECK_THAT(result.err, Contains("new.json") && Contains("device/name") && Contains("another device"));

  Json incomplete = shared_bench().parsed();
  incomplete.erase("latency_ms");
  CHECK(compare_with(incomplete).code == 3);
  CHECK(compare_with(Json{{"schema", 1}}).code == 3);

  for (const char* pointer :
       {"/latency_ms/median", "/latency_ms/first", "/edge_detection_ms/median", "/stages_ms/stereo/median",
        "/kernels_ms/edge_detection/median", "/start_ms/total", "/memory_mb/host_peak", "/moved_mb_per_frame/to_host",
        "/frames_lost", "/baseline/opencv_sift_both_ms"}) {
    for (const Json& value : {Json(nullptr), Json("fast"), Json(-1)}) {
      INFO(pointer << " " << value.dump());
      Json changed = shared_bench().parsed();
      changed[Json::json_pointer(pointer)] = value;
      result = compare_with(changed);
      CHECK(result.code == 3);
      CHECK_THAT(result.err, Contains("new.json: found " + std::string(pointer + 1) + " " + value.dump()) &&
                                 Contains("expected a number"));
    }
  }
  for (const auto& [key, known] :
       {std::pair<std::string, int>{"schema", report::kReportSchema}, {"bench_schema", bench::kBenchSchema}}) {
    INFO(key);
    Json changed = shared_bench().parsed();
    changed[key] = 77;
    result = compare_with(changed);
    CHECK(result.code == 3);
    CHECK_THAT(result.err, Contains("new.json: found " + key + " 77, expected " + std::to_string(known)));
  }

  const TemporaryFolder folder;
  std::ofstream(folder / "text.json") << "no JSON";
  check_error({"bench", "--compare", folder / "text.json", folder / "text.json"}, 3, {"text.json"});
}

TEST_CASE("bench: the chosen threshold gives the requested number of edges", "[device]") {
  const matching::RenderedScene scene("room", 160, 100, 1);
  FramePrefetcher::Frame frame;
  frame.left = scene.left.front();
  frame.right = scene.right.front();
  for (const auto& name : all_devices()) {
    Device device(name, kept_programs());
    for (const int wanted : {600, 1500}) {
      Config config = scene.config;
      config.edges.threshold = bench::threshold_for_edges(frame, wanted, device, config);
      const auto frontend = frontend::make_frontend(scene.rig, device, config);
      frontend->process(scene.frame(0));
      CHECK((frontend->counts().edges_left + frontend->counts().edges_right) / 2 == Approx(wanted).epsilon(0.02));
    }
    Config few = scene.config;
    few.edges.max_edges = 100;
    CHECK_THROWS_AS(bench::threshold_for_edges(frame, 101, device, few), UsageError);
    // More than there are: all maxima, with a threshold above 0, which would mean the automatic one.
    const double all = bench::threshold_for_edges(frame, 200000, device, scene.config);
    CHECK((all > 0 && all < 1e-3));
  }
}
