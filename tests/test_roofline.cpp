/// \file test_roofline.cpp  Estimates of a frame on GPUs that are not there: `quadedge compare --device-model`.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "benchmark/roofline.hpp"
#include "devices.hpp"
#include "opencl/variants.hpp"
#include "program.hpp"
#include "quadedge/error.hpp"
#include "quadedge/synthetic.hpp"

using Catch::Matchers::Contains;
using Json = nlohmann::json;
using namespace quadedge;
namespace fs = std::filesystem;

namespace {

const std::string kModels = QUADEDGE_KERNELS "/../config/devices";

/// The keys of a made-up model, in the order that they are written.
using Keys = std::vector<std::pair<std::string, std::string>>;
Keys made_up_keys() {
  return {{"name", "\"Made-up GPU\""},
          {"source", "\"a sheet\""},
          {"assumptions", "\"half\""},
          {"memory_gb_s", "100"},
          {"memory_attainable", "0.5"},
          {"arithmetic_gflop_s", "1000"},
          {"arithmetic_attainable", "0.25"},
          {"transfer_gb_s", "10"},
          {"transfer_attainable", "0.8"},
          {"launch_us", "4"},
          {"wait_us", "10"},
          {"goal_ms", "0.8"}};
}

void write_model(const std::string& file, const Keys& keys) {
  std::ofstream out(file);
  for (const auto& [key, value] : keys) out << key << " = " << value << "\n";
}

/// The made-up model with another value of a key; nothing takes the key away.
Keys changed(const std::string& key, const std::string& value) {
  Keys keys;
  for (const auto& row : made_up_keys()) {
    if (row.first != key) keys.push_back(row);
  }
  if (!value.empty()) keys.emplace_back(key, value);
  return keys;
}

/// What reading it complains about.
std::string refusal(const Keys& keys) {
  const TemporaryFolder folder;
  write_model(folder / "model.toml", keys);
  try {
    bench::read_device_model(folder / "model.toml");
  } catch (const DataError& error) {
    const std::string message = error.what();
    REQUIRE(message.rfind(folder / "model.toml", 0) == 0);
    return message;
  }
  return "";
}

bench::StageCount stage(const std::string& name, double bytes, double operations) {
  bench::StageCount row;
  row.stage = name;
  row.work = {bytes, operations};
  return row;
}

ProgramResult estimate(const std::string& model, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"compare", "--size",        "160x100", "--edges",        "0",
                                        "--quiet", "--repetitions", "2",       "--device-model", model};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_program(arguments);
}

}  // namespace

TEST_CASE("roofline: times of a made-up model are those computed by hand", "[bench]") {
  const TemporaryFolder folder;
  write_model(folder / "model.toml", made_up_keys());
  const auto model = bench::read_device_model(folder / "model.toml");
  CHECK(model.name == "Made-up GPU");

  // 50 bytes, 250 operations and 8 copied bytes per nanosecond; 4 us per launch and copy to the device, 10 us per wait.
  bench::FrameCount count;
  count.host_ms = 1.5;
  count.stages = {stage("a", 5e6, 50e6), stage("b", 10e6, 25e6), stage("c", 0, 0)};
  count.stages[0].launches = 3;
  count.stages[0].writes = 1;
  count.stages[0].waits = 2;
  count.stages[0].to_device = 600'000;
  count.stages[0].to_host = 200'000;
  count.stages[1].launches = 1;
  count.stages[2].waits = 30;

  auto frame = bench::estimate_frame(model, count);
  REQUIRE(frame.stages.size() == 3);
  const auto& a = frame.stages[0];
  CHECK(a.memory_ms == Approx(5e6 / 50 * 1e-6));
  CHECK(a.arithmetic_ms == Approx(50e6 / 250 * 1e-6));
  CHECK(a.launches_ms == Approx((3 + 1) * 0.004));
  CHECK(a.waits_ms == Approx(2 * 0.010));
  CHECK(a.transfers_ms == Approx((600'000 + 200'000) / 8.0 * 1e-6));
  CHECK(a.total_ms() == Approx(0.2 + 0.016 + 0.020 + 0.1));  // arithmetic takes longer than memory
  CHECK(a.bound() == "arithmetic");
  CHECK(frame.stages[1].total_ms() == Approx(0.2 + 0.004));  // and here memory does
  CHECK(frame.stages[1].bound() == "memory");
  CHECK(frame.stages[2].total_ms() == Approx(30 * 0.010));
  CHECK(frame.stages[2].bound() == "waits");
  CHECK(frame.by_time()[1].stage == "c");
  CHECK(frame.device_ms() == Approx(0.336 + 0.204 + 0.3));
  CHECK(frame.frame_ms() == Approx(0.336 + 0.204 + 0.3 + 1.5));

  CHECK(frame.in_the_way() == std::vector<std::string>{"host", "a"});  // b and c are 0.504 ms together, of 0.8 ms
  frame.model.goal_ms = 0.9;
  CHECK(frame.in_the_way() == std::vector<std::string>{"host"});
  frame.model.goal_ms = 0.1;
  CHECK(frame.in_the_way() == std::vector<std::string>{"host", "a", "c", "b"});
  frame.model.goal_ms = 2.4;
  CHECK(frame.in_the_way().empty());
  frame.model.goal_ms = 0;
  CHECK(frame.in_the_way().empty());
}

TEST_CASE("roofline: a model that makes no sense is refused by file, key and what was expected", "[bench]") {
  CHECK(refusal(made_up_keys()).empty());
  CHECK(refusal(changed("goal_ms", "")).empty());
  CHECK(refusal(changed("launch_us", "0")).empty());
  CHECK_THAT(refusal(changed("memory_gb_s", "0")), Contains("memory_gb_s: expected a number above 0, found 0"));
  CHECK_THAT(refusal(changed("arithmetic_gflop_s", "inf")), Contains("arithmetic_gflop_s: expected a number above 0"));
  CHECK_THAT(refusal(changed("transfer_gb_s", "\"fast\"")), Contains("transfer_gb_s: expected a number above 0"));
  CHECK_THAT(refusal(changed("memory_attainable", "1.01")),
             Contains("memory_attainable: expected a share above 0 and up to 1, found 1.01"));
  CHECK_THAT(refusal(changed("arithmetic_attainable", "0")), Contains("arithmetic_attainable: expected a share"));
  CHECK_THAT(refusal(changed("wait_us", "-1")), Contains("wait_us: expected a number of 0 or more, found -1"));
  CHECK_THAT(refusal(changed("goal_ms", "nan")), Contains("goal_ms: expected a number above 0"));
  CHECK_THAT(refusal(changed("name", "3")), Contains("name: expected a text in quotes, found 3"));
  CHECK_THAT(refusal(changed("source", "\"\"")), Contains("source: expected a text that is not empty"));
  CHECK_THAT(refusal(changed("launch_us", "")), Contains("launch_us is missing; expected a number of 0 or more"));
  CHECK_THAT(refusal(changed("source", "")), Contains("source is missing; expected a text in quotes"));
  CHECK_THAT(refusal(changed("wait_ms", "3")), Contains("unknown key \"wait_ms\"; did you mean 'wait_us'"));
  CHECK_THAT(refusal({{"no", "TOML = 3"}}), Contains("no TOML"));
}

TEST_CASE("roofline: the models that are shipped can be read and differ", "[bench]") {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kModels)) {
    INFO(entry.path());
    const auto model = bench::read_device_model(entry.path().string());
    CHECK(std::find(names.begin(), names.end(), model.name) == names.end());
    names.push_back(model.name);
    CHECK((model.goal_ms == 5) == (entry.path().filename() == "h100.toml"));
  }
  CHECK(names.size() == 3);
}

TEST_CASE("roofline: what a stage asks of the queue adds up to what all do", "[bench][device]") {
  SyntheticOptions options;
  options.width = 161;
  options.height = 97;
  options.frames = 3;
  const SyntheticSequence scene(options);
  Config config;
  config.stereo.max_disparity = scene.max_disparity();
  std::vector<FramePrefetcher::Frame> frames(3);
  for (int i = 0; i < 3; ++i) {
    auto& frame = frames[static_cast<std::size_t>(i)];
    frame.stamp_ns = scene.stamp_ns(i);
    frame.left = scene.render(i, Side::left).image;
    frame.right = scene.render(i, Side::right).image;
  }
  const StereoRig rig = scene.rig();
  const std::string name = all_devices().front();
  const bench::Subject subject{rig, frames, config,
                               [&](bool profiling) {
                                 DeviceOptions device_options = kept_programs();
                                 device_options.profiling = profiling;
                                 return Device(name, device_options);
                               },
                               [](const char*, int, int) {}};
  const auto count = bench::count_stages(subject, 0);
  CHECK(count.frames == 2);
  for (const auto& variant : opencl::all_variants()) {
    if (variant.default_on_gpu) CHECK(count.variants.at(variant.stage) == variant.name);
  }
  CHECK_THROWS_AS(bench::count_stages(subject, 1), UsageError);

  // The same frames with the same forms, counted as a whole.
  config.variants = count.variants;
  Device device(name, kept_programs());
  StereoOdometry odometry(rig, device, config);
  odometry.track(frames[0].view());
  const auto before = device.context()->traffic();
  for (std::size_t i = 1; i < 3; ++i) odometry.track(frames[i].view());
  const auto& after = device.context()->traffic();
  bench::StageCount sum;
  for (const auto& row : count.stages) {
    INFO(row.stage);
    sum.launches += row.launches;
    sum.writes += row.writes;
    sum.waits += row.waits;
    sum.to_device += row.to_device;
    sum.to_host += row.to_host;
    if (row.launches > 0) {
      CHECK(row.work.bytes > 0);
      CHECK(row.work.operations > 0);
    }
  }
  CHECK(2 * sum.launches == Approx(after.launches - before.launches));
  CHECK(2 * sum.writes == Approx(after.writes - before.writes));
  CHECK(2 * sum.waits == Approx(after.waits - before.waits));
  CHECK(2 * sum.to_device == Approx(after.to_device - before.to_device));
  CHECK(2 * sum.to_host == Approx(after.to_host - before.to_host));
  CHECK(sum.waits > 0);
}

TEST_CASE("compare: an estimate says that it is one, on which model, and what was measured", "[cli][bench][device]") {
  const TemporaryFolder folder;
  const auto result = estimate(kModels + "/h100.toml",
                               {"--device-model", kModels + "/iris-xe.toml", "--json", folder / "estimate.json"});
  INFO(result.err << result.out);
  REQUIRE(result.code == 0);
  CHECK_THAT(result.out, Contains("ESTIMATE, not measured: a tracked frame on the model NVIDIA H100") &&
                             Contains("ESTIMATE, not measured: a tracked frame on the model Intel Iris Xe"));
  std::istringstream lines(result.out);
  for (std::string line; std::getline(lines, line);) {
    INFO(line);
    if (line.find("measured") != std::string::npos)
      CHECK((line.rfind("ESTIMATE, not measured", 0) == 0 || line.rfind("host ", 0) == 0));
  }
  const Json json = Json::parse(read_text(folder / "estimate.json"));
  REQUIRE(json["estimates"].size() == 2);
  for (const auto& estimate : json["estimates"]) {
    CHECK(estimate["kind"] == "estimate, not measured");
    CHECK_FALSE(estimate["model"]["name"].get<std::string>().empty());
    double device_ms = 0;
    for (const auto& row : estimate["stages"]) device_ms += row["estimate_ms"].get<double>();
    CHECK(estimate["device_estimate_ms"].get<double>() == Approx(device_ms));
    CHECK(estimate["frame_estimate_ms"].get<double>() == Approx(device_ms + json["host_measured_ms"].get<double>()));
  }
  CHECK(json["counted"]["variants"]["edge_detection"] == "tile256");
}

TEST_CASE("compare: a model that cannot be read ends with code 3, what does not go with one with code 2",
          "[cli][bench]") {
  const TemporaryFolder folder;
  write_model(folder / "bad.toml", changed("launch_us", "-2"));
  const auto bad = estimate(folder / "bad.toml");
  CHECK(bad.code == 3);
  CHECK_THAT(bad.err, Contains(folder / "bad.toml") && Contains("launch_us: expected a number of 0 or more, found -2"));
  CHECK(estimate(folder / "missing.toml").code == 3);
  CHECK(estimate(folder.path()).code == 3);
  write_model(folder / "good.toml", made_up_keys());
  CHECK(estimate(folder / "good.toml", {"--save"}).code == 2);
  CHECK(estimate(folder / "good.toml", {"--stage", "scan"}).code == 2);
  CHECK(estimate(folder / "good.toml", {"--device", "reference"}).code == 2);
}
