/// \file test_self_test.cpp  The self-test: correct devices pass, faulty ones are reported.
#include "device/stage.hpp"
#include "edges/self_test_data.hpp"
#include "program.hpp"
#include "self_test_now.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;

namespace {

/// Copies the kernels with one text replaced.
void copy_kernels(const std::string& folder, const std::string& file, const std::string& what, const std::string& by) {
  std::filesystem::copy(QUADEDGE_KERNELS, folder);
  std::string text = read_text(folder + "/" + file);
  const auto at = text.find(what);
  REQUIRE(at != std::string::npos);
  std::ofstream(folder + "/" + file) << text.replace(at, what.size(), by);
}

}  // namespace

TEST_CASE("self-test: the stored frames and rows are what the renderer and the reference make now", "[selftest]") {
  const frontend::SelfTestData now = self_test_now();
  const bool is_up_to_date = frontend::bytes_of(now) == frontend::bytes_of(frontend::self_test_data());
  INFO("cmake --build build --target self_test_data, for a change that is meant");
  CHECK(is_up_to_date);
  CHECK(now.paper_config().stereo.sift_max == read_preset("paper").stereo.sift_max);
}

TEST_CASE("self-test: every stage of the reference finds something to compare", "[selftest]") {
  Device reference("reference");
  for (const auto& stage : frontend::observe_stages(frontend::self_test_data().sequence, reference, {})) {
    INFO(stage.stage);
    CHECK(stage.rows.size() >= (stage.stage == "edge_threshold" ? 1U : 50U));
  }
}

TEST_CASE("self-test: every device passes, with the kernels for CPUs and for GPUs", "[selftest][device]") {
  opencl::DeviceLimits limits;
  limits.type = GENERATE(as<std::string>(), "cpu", "gpu");
  Device device = opencl::open_limited(GENERATE(from_range(all_devices())), kept_programs(), limits);
  const auto result = self_test(device);
  INFO(*limits.type << " " << result.stage << ": " << result.difference);
  CHECK(result.passed());
}

TEST_CASE("self-test: differing rows are counted and the first is shown", "[selftest]") {
  frontend::StageRows expected{"scan", {}}, found;
  for (int i = 0; i < 100; ++i) expected.rows.push_back({10 * i, 0, 0, 0, 0});
  found = expected;
  found.rows[7][0] += frontend::StageRows::kTolerance;
  CHECK(frontend::difference(found, expected, 0.0) == "");
  found.rows[7][1] = frontend::StageRows::kTolerance + 1;
  CHECK(frontend::difference(found, expected, 0.01) == "");
  CHECK_THAT(frontend::difference(found, expected, 0.009),
             Contains("1 are wrong and 1 are missing") && Contains("(70 0 0 0 0)"));
  found.rows.clear();
  CHECK_THAT(frontend::difference(found, expected, 0.5), Contains("0 results, the reference has 100"));
}

TEST_CASE("self-test: a long loop reaches its end on every device", "[selftest][device][oclgrind]") {
  for (const auto& index : all_devices()) {
    Device device(index, kept_programs());
    const bool is_slow = device.info().name.find("Oclgrind") != std::string::npos;  // minutes for the whole loop
    CHECK(stages::long_loop_difference(*device.context(), is_slow ? 1000 : stages::kLongLoop).empty());
  }
}

TEST_CASE("self-test: a driver that ends long loops early is reported, although small frames are right",
          "[selftest][device]") {
  const TemporaryFolder folder;
  copy_kernels(folder / "kernels", "long_loop.cl", "i < rounds", "i < min(rounds, 65535)");
  DeviceOptions options = kept_programs();
  options.kernel_folder = folder / "kernels";
  Device device(all_devices().front(), options);
  const auto result = self_test(device);
  CHECK(result.stage == "long_loop");
  CHECK_THAT(result.difference, Contains("1000000 rounds"));
}

TEST_CASE("self-test: a faulty device is refused with the stage's name, and --trust continues",
          "[selftest][cli][device]") {
  const TemporaryFolder folder;
  // Hardly any similarity passes the filter.
  copy_kernels(folder / "kernels", "candidate_filters.cl", "similarity < limits.ncc_min", "similarity < 0.99f");
  const Words demo = {"demo",      "--frames",         "2",  "--size",      "322x200",
                      "--kernels", folder / "kernels", "-o", folder / "out"};
  const auto refused = run_program(demo);
  CHECK(refused.code == 4);
  CHECK_THAT(refused.err, Contains("fails the self-test at stage candidate_filters: ") && Contains("--trust"));
  const auto trusted = run_program(demo + Words{"--trust"});
  CHECK(trusted.code != 4);
  CHECK_THAT(trusted.err, Contains("fails the self-test at stage candidate_filters"));
  CHECK_THAT(read_text(folder / "out/report.json"), Contains("\"verdict\": \"failed\""));
}

TEST_CASE("self-test: the verdict is cached and shown by `devices`, and a damaged one is ignored",
          "[selftest][cli][device]") {
  const TemporaryFolder folder;
  const std::string environment = "XDG_CACHE_HOME='" + (folder / "cache") + "'";
  const auto devices = [&] { return run_program({"devices"}, environment).out; };
  CHECK_THAT(devices(), Contains("self-test: not run yet"));
  std::ofstream(folder / "image.pgm") << "P5 40 40 255\n" + [] {
    std::string pixels;
    for (int i = 0; i < 1600; ++i) pixels += i % 40 < 20 ? '2' : 'z';
    return pixels;
  }();
  REQUIRE(run_program({"edges", folder / "image.pgm"}, environment).code == 0);
  CHECK_THAT(devices(), Contains("self-test: passed"));
  for (const auto& entry : std::filesystem::directory_iterator(folder / "cache/quadedge/self_tests"))
    std::ofstream(entry.path()) << "{";
  CHECK_THAT(devices(), Contains("self-test: not run yet"));
}

TEST_CASE("self-test: `auto` goes on to the next device with a warning, a device named by hand ends the run",
          "[selftest][cli][device]") {
  const TemporaryFolder folder;
  // PoCL offers two devices, and the verdict on the first one is changed to a failure.
  const std::string environment = "XDG_CACHE_HOME='" + (folder / "cache") + "' POCL_DEVICES='pthread basic'";
  std::ofstream(folder / "image.pgm") << "P5 40 40 255\n" + std::string(1600, '2');
  const auto edges = [&](const Words& device) {
    return run_program(Words{"edges", folder / "image.pgm"} + device, environment);
  };
  if (edges({"--device", "1"}).code != 0) {
    WARN("there is no second device");
    return;
  }
  std::filesystem::remove_all(folder / "cache/quadedge/self_tests");
  REQUIRE(edges({"--device", "0"}).code == 0);
  for (const auto& entry : std::filesystem::directory_iterator(folder / "cache/quadedge/self_tests")) {
    std::string text = read_text(entry.path());
    const std::string passed = "\"stage\": \"\"";
    REQUIRE(text.find(passed) != std::string::npos);
    std::ofstream(entry.path()) << text.replace(text.find(passed), passed.size(), "\"stage\": \"patches\"");
  }
  const auto automatic = edges({});
  CHECK(automatic.code == 0);
  CHECK_THAT(automatic.err, Contains("warning: device 0 is skipped: ") &&
                                Contains("fails the self-test at stage patches") && Contains("trying device 1"));
  const auto by_hand = edges({"--device", "0"});
  CHECK(by_hand.code == 4);
  CHECK_THAT(by_hand.err, Contains("fails the self-test at stage patches") && !Contains("skipped"));
  CHECK(edges({"--device", "0", "--trust"}).code == 0);
}

TEST_CASE("self-test: where division is not rounded correctly, programs are built without it and the tolerance decides",
          "[selftest]") {
  constexpr const char* kOption = "-cl-fp32-correctly-rounded-divide-sqrt";
  opencl::DeviceLimits limits;
  limits.exact_divide_sqrt = GENERATE(true, false);
  const bool offered = list_devices().front().single_precision.exact_divide_sqrt;
  if (*limits.exact_divide_sqrt && !offered) return;  // the driver would refuse the option
  Device device = opencl::open_limited("0", kept_programs(), limits);
  CHECK(device.info().single_precision.exact_divide_sqrt == *limits.exact_divide_sqrt);
  CHECK(self_test(device).passed());
  REQUIRE_FALSE(device.context()->programs().empty());
  for (const auto& program : device.context()->programs())
    CHECK((program.find(kOption) != std::string::npos) == *limits.exact_divide_sqrt);
}
