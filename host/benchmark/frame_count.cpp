#include "benchmark/frame_count.hpp"

#include <algorithm>

#include "opencl/variants.hpp"
#include "quadedge/error.hpp"
#include "report/statistics.hpp"

namespace quadedge::bench {
namespace {

using Traffic = std::map<std::string, opencl::Context::Traffic>;

/// The forms of GPUs for all stages that `chosen` says nothing of.
std::map<std::string, std::string> gpu_forms(std::map<std::string, std::string> chosen) {
  for (const auto& variant : opencl::all_variants()) {
    if (variant.default_on_gpu) chosen.emplace(variant.stage, variant.name);
  }
  return chosen;
}

opencl::Context::Traffic of_stage(const Traffic& traffic, const std::string& stage) {
  const auto found = traffic.find(stage);
  return found == traffic.end() ? opencl::Context::Traffic() : found->second;
}

/// Launches by stage between two moments.
std::map<std::string, double> launches_between(const Traffic& before, const Traffic& after) {
  std::map<std::string, double> launches;
  for (const auto& [stage, traffic] : after)
    launches[stage] = static_cast<double>(traffic.launches - of_stage(before, stage).launches);
  return launches;
}

/// Launches of one run of what least_work() is about: a guided search, or else a coarse one.
std::map<std::string, double> launches_of_one_run(const Subject& subject, Device& device, const Config& config) {
  const auto frontend = frontend::make_frontend(subject.rig, device, config);
  const auto& traffic = device.context()->stage_traffic();
  const auto base = frontend->process(subject.frames[subject.frames.size() - 2].view());
  const Traffic start = traffic;
  frontend->process(subject.frames.back().view());
  frontend->match(*base, search_without_motion(base->edges, config.temporal, false));
  frontend->match_anywhere(*base);
  const Traffic guided = traffic;
  frontend->match(*base, search_without_motion(base->edges, config.temporal, true));
  auto launches = launches_between(start, guided);
  for (const auto& [stage, coarse] : launches_between(guided, traffic)) {
    double& sum = launches[stage];
    if (sum == 0) sum = coarse;
  }
  return launches;
}

/// The stages of the table of variants in its order, then the others.
std::vector<std::string> in_order(const Traffic& traffic) {
  std::vector<std::string> stages;
  for (const auto& variant : opencl::all_variants()) {
    if (stages.empty() || stages.back() != variant.stage) stages.push_back(variant.stage);
  }
  for (const auto& [stage, unused] : traffic) {
    if (std::find(stages.begin(), stages.end(), stage) == stages.end()) stages.push_back(stage);
  }
  return stages;
}

/// The host's part of a frame with the device's own forms, median [ms].
double measure_host(const Subject& subject, int warm_up) {
  BenchRecord record;
  record.warm_up = warm_up;
  measure_kernels(subject, record);
  std::vector<double> times;
  for (const auto& frame : record.profiled) times.push_back(frame.host_ms());
  return report::median(times);
}

}  // namespace

FrameCount count_stages(const Subject& subject, int warm_up) {
  FrameCount count;
  count.frames = static_cast<int>(subject.frames.size()) - 1 - warm_up;
  if (count.frames < 2) throw UsageError("a frame's stages are counted on two frames or more");
  Config config = subject.config;
  config.variants = gpu_forms(config.variants);
  Device device = subject.open_device(false);
  Traffic before, after;
  {
    StereoOdometry odometry(subject.rig, device, config);
    count.variants = odometry.variants();
    for (int i = 0; i < static_cast<int>(subject.frames.size()); ++i) {
      if (i == 1 + warm_up) before = device.context()->stage_traffic();
      const auto result = odometry.track(subject.frames[static_cast<std::size_t>(i)].view());
      if (i > warm_up && is_tracked(result.status)) ++count.tracked;
      subject.progress("counting", i + 1, static_cast<int>(subject.frames.size()));
    }
    after = device.context()->stage_traffic();
  }
  const auto own = frontend::make_frontend(subject.rig, device, subject.config);
  const FrameSize size =
      count_frame(*own, subject.frames[subject.frames.size() - 2], subject.frames.back(), subject.config);
  count.left_edges = size.left_edges;
  count.right_edges = size.edges - size.left_edges;
  const auto one_run = launches_of_one_run(subject, device, config);
  const double frames = count.frames;
  for (const auto& stage : in_order(after)) {
    const auto from = of_stage(before, stage), to = of_stage(after, stage);
    StageCount row;
    row.stage = stage;
    row.launches = static_cast<double>(to.launches - from.launches) / frames;
    row.writes = static_cast<double>(to.writes - from.writes) / frames;
    row.waits = static_cast<double>(to.waits - from.waits) / frames;
    row.to_device = static_cast<double>(to.to_device - from.to_device) / frames;
    row.to_host = static_cast<double>(to.to_host - from.to_host) / frames;
    if (row.launches + row.writes + row.waits + row.to_host == 0) continue;
    const auto once = one_run.find(stage);
    if (row.launches > 0 && once != one_run.end() && once->second > 0) {
      const StageWork least = least_work(stage, size, config);
      const double runs = row.launches / once->second;
      row.work = {runs * least.bytes, runs * least.operations};
    }
    count.stages.push_back(row);
  }
  count.host_ms = measure_host(subject, warm_up);
  return count;
}

}  // namespace quadedge::bench
