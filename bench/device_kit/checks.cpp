/// \file checks.cpp  The parts of device_check that ask whether a device computes what it should.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <sstream>

#include "common/disparity_range.hpp"
#include "common/run_cost.hpp"
#include "device_kit/parts.hpp"
#include "device_kit/stage_arrays.hpp"
#include "frontend/frontend.hpp"
#include "opencl/context.hpp"
#include "quadedge/error.hpp"
#include "quadedge/self_test.hpp"

namespace device_kit {

using namespace quadedge;

void self_test_part(const Options& options) {
  const auto start = Clock::now();
  Device device = options.open_device(false);
  const double opened = milliseconds_since(start);
  const SelfTestResult result = self_test(device);
  options.rows.add("self_test", {{"start", options.argument(0)},
                                 {"verdict", result.passed() ? "passed" : result.stage + ": " + result.difference},
                                 {"opening the device [ms]", number(opened)},
                                 {"building or loading programs [ms]", number(device.context()->build_ms())},
                                 {"in all [ms]", number(milliseconds_since(start))}});
}

namespace {

/// Every program that a frame needs by default, in the form of Context::programs().
std::vector<std::string> default_programs(const Options& options, const Sequence& sequence) {
  StereoRig rig = sequence.rig;
  const auto pixels = static_cast<std::size_t>(rig.left.width) * static_cast<std::size_t>(rig.left.height);
  // Kernels for lens distortion and masks are built only for rigs that have them.
  rig.left_undistortion = {rig.left.width, rig.left.height, std::vector<float>(pixels), std::vector<float>(pixels)};
  rig.left_mask = {rig.left.width, rig.left.height, std::vector<std::uint8_t>(pixels)};
  Config config = with_disparity_range({}, sequence.rig);
  config.stereo.sift_max = 500;
  Device device = options.open_device(false);
  const auto frontend = frontend::make_frontend(rig, device, config);
  return device.context()->programs();
}

}  // namespace

void programs_part(const Options& options) {
  const Sequence sequence = options.sequence();
  const auto programs = default_programs(options, sequence);
  Options cold = options;
  cold.programs.clear();
  const Device device = cold.open_device(false);
  double sum = 0;
  for (const auto& program : programs) {
    opencl::Defines defines;
    std::vector<std::string> files;
    std::istringstream words(program);
    for (std::string word; words >> word;) {
      const auto equals = word.find('=');
      if (word.rfind("-D", 0) == 0 && equals != std::string::npos)
        defines[word.substr(2, equals - 2)] = word.substr(equals + 1);
      else if (word.front() != '-')
        files.push_back(word);
    }
    const double before = device.context()->build_ms();
    device.context()->program(files, defines);
    const double ms = device.context()->build_ms() - before;
    sum += ms;
    options.rows.add("programs", {{"program", files.empty() ? "common.cl" : files.back()}, {"build [ms]", number(ms)}});
  }
  options.rows.add("programs", {{"program", "all " + std::to_string(programs.size())}, {"build [ms]", number(sum)}});
}

namespace {

constexpr double kAllowed = 1e-5;  // px, m, rad
const char* const kPresets[] = {"fast", "default", "dense"};

std::string stage_file(const Options& options) { return options.data + "/" + options.argument(0) + "/stages"; }
std::string pose_file(const Options& options, const std::string& preset) {
  return options.data + "/" + options.argument(0) + "/poses_" + preset;
}

std::vector<StageArray> track(const Options& options, const Sequence& sequence, const std::string& preset) {
  Device device = options.open_device(false);
  StereoOdometry odometry(sequence.rig, device, options.preset(preset));
  std::vector<FrameResult> results;
  for (const auto& frame : sequence.frames) results.push_back(odometry.track(frame.view()));
  return pose_arrays(results);
}

/// What values of a kind may differ by: positions by 1e-5, similarities as in the self-test.
double allowed(const std::string& values) {
  if (values.find("NCC") != std::string::npos) return 0.006;
  return values == "distance" ? 3 : kAllowed;
}

/// All arrays of one stage as one row.
struct StageSum {
  std::size_t values = 0, differing = 0;
  double largest = 0, share = 0;  ///< difference, and its share of what is allowed; of the array where that is largest
  std::string where;

  void add(const ArrayDifference& difference, const std::string& array) {
    values += difference.values;
    differing += difference.differing;
    if (difference.largest / allowed(array) <= share) return;
    share = difference.largest / allowed(array);
    largest = difference.largest;
    where = array;
    if (difference.values != difference.found)
      where += ": " + std::to_string(difference.found) + " instead of " + std::to_string(difference.values) + " values";
  }
};

void compare_stages(const Options& options, const Sequence& sequence) {
  Device device = options.open_device(false);
  const auto expected = read_arrays(stage_file(options));
  const auto found = observe_arrays(sequence, device, with_disparity_range(options.preset("default"), sequence.rig));
  std::vector<std::string> order;
  std::map<std::string, StageSum> sums;
  for (const auto& array : expected) {
    if (sums.count(array.stage) == 0) order.push_back(array.stage);
    const auto same = std::find_if(found.begin(), found.end(), [&](const StageArray& other) {
      return other.stage == array.stage && other.values == array.values;
    });
    StageArray none = array;
    none.bytes.clear();
    sums[array.stage].add(difference(same == found.end() ? none : *same, array), array.values);
  }
  for (const auto& stage : order) {
    const StageSum& sum = sums[stage];
    const bool is_equal = sum.differing == 0 && sum.share == 0;
    options.rows.add("stages", {{"sequence", sequence.name},
                                {"stage", stage},
                                {"values", std::to_string(sum.values)},
                                {"bytes", is_equal ? "equal" : std::to_string(sum.differing) + " values differ"},
                                {"largest difference", std::isfinite(sum.largest) ? number(sum.largest) : "-"},
                                {"largest in", sum.where},
                                {"verdict", sum.share < 1 ? "passes" : "FAILS"}});
  }
}

void compare_poses(const Options& options, const Sequence& sequence, const std::string& preset) {
  const auto expected = read_arrays(pose_file(options, preset)), found = track(options, sequence, preset);
  std::size_t equal = 0, same_status = 0;
  double largest = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const bool agree = found.at(i).values == expected[i].values;  // the status
    same_status += agree ? 1 : 0;
    const ArrayDifference apart = difference(found[i], expected[i]);
    equal += apart.is_equal() ? 1 : 0;
    double squares = 0;
    for (const std::size_t k : {3, 7, 11}) squares += std::pow(found[i].at(k) - expected[i].at(k), 2);
    const double metres = std::sqrt(squares);
    largest = std::max(largest, metres);
    if (apart.is_equal() && agree) continue;
    options.rows.add("differing_poses", {{"sequence", sequence.name},
                                         {"preset", preset},
                                         {"frame", std::to_string(i)},
                                         {"status", found[i].values},
                                         {"on the CPU", expected[i].values},
                                         {"position apart [m]", number(metres)},
                                         {"largest value apart", number(apart.largest)}});
  }
  const std::string all = std::to_string(expected.size());
  options.rows.add("poses", {{"sequence", sequence.name},
                             {"preset", preset},
                             {"same status", std::to_string(same_status) + " of " + all},
                             {"equal bytes", std::to_string(equal) + " of " + all},
                             {"largest difference [m]", number(largest)},
                             {"verdict", largest < kAllowed && same_status == expected.size() ? "passes" : "FAILS"}});
}

}  // namespace

void compare_part(const Options& options) {
  const Sequence sequence = options.sequence();
  compare_stages(options, sequence);
  for (const std::string preset : kPresets) compare_poses(options, sequence, preset);
}

void record_part(const Options& options) {
  const Sequence sequence = options.sequence();
  Device device = options.open_device(false);
  write_arrays(stage_file(options),
               observe_arrays(sequence, device, with_disparity_range(options.preset("default"), sequence.rig)));
  for (const std::string preset : kPresets) write_arrays(pose_file(options, preset), track(options, sequence, preset));
}

}  // namespace device_kit
