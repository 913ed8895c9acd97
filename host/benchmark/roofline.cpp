#include "benchmark/roofline.hpp"

#include <algorithm>
#include <utility>

#include "report/json_values.hpp"

namespace quadedge::bench {
namespace {

constexpr double kMsPerUs = 1e-3;

/// Time of `amount` at 1e9 per second and the attainable share of it [ms].
double at_rate(double amount, double per_second, double attainable) { return amount / (per_second * attainable * 1e6); }

}  // namespace

double StageEstimate::total_ms() const {
  return std::max(memory_ms, arithmetic_ms) + launches_ms + waits_ms + transfers_ms;
}

std::string StageEstimate::bound() const {
  const std::pair<double, const char*> parts[] = {{memory_ms, "memory"},
                                                  {arithmetic_ms, "arithmetic"},
                                                  {launches_ms, "launches"},
                                                  {waits_ms, "waits"},
                                                  {transfers_ms, "transfers"}};
  return std::max_element(std::begin(parts), std::end(parts),
                          [](const auto& a, const auto& b) { return a.first < b.first; })
      ->second;
}

double FrameEstimate::device_ms() const {
  double sum = 0;
  for (const auto& stage : stages) sum += stage.total_ms();
  return sum;
}

double FrameEstimate::frame_ms() const { return device_ms() + host_ms; }

std::vector<std::string> FrameEstimate::in_the_way() const {
  std::vector<std::string> names;
  if (model.goal_ms == 0) return names;
  std::vector<std::pair<double, std::string>> parts = {{host_ms, "host"}};
  for (const auto& stage : stages) parts.emplace_back(stage.total_ms(), stage.stage);
  std::stable_sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  double rest = frame_ms();
  for (const auto& [ms, name] : parts) {
    if (rest <= model.goal_ms) break;
    names.push_back(name);
    rest -= ms;
  }
  return names;
}

std::vector<StageEstimate> FrameEstimate::by_time() const {
  std::vector<StageEstimate> sorted = stages;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.total_ms() > b.total_ms(); });
  return sorted;
}

FrameEstimate estimate_frame(const DeviceModel& model, const FrameCount& count) {
  FrameEstimate frame;
  frame.model = model;
  frame.host_ms = count.host_ms;
  for (const auto& stage : count.stages) {
    StageEstimate row;
    row.stage = stage.stage;
    row.memory_ms = at_rate(stage.work.bytes, model.memory_gb_s, model.memory_attainable);
    row.arithmetic_ms = at_rate(stage.work.operations, model.arithmetic_gflop_s, model.arithmetic_attainable);
    row.launches_ms = (stage.launches + stage.writes) * model.launch_us * kMsPerUs;
    row.waits_ms = stage.waits * model.wait_us * kMsPerUs;
    row.transfers_ms = at_rate(stage.to_device + stage.to_host, model.transfer_gb_s, model.transfer_attainable);
    frame.stages.push_back(row);
  }
  return frame;
}

namespace {

using report::Json;

Json model_json(const DeviceModel& model) {
  return {{"name", model.name},
          {"source", model.source},
          {"assumptions", model.assumptions},
          {"memory_gb_s", model.memory_gb_s},
          {"memory_attainable", model.memory_attainable},
          {"arithmetic_gflop_s", model.arithmetic_gflop_s},
          {"arithmetic_attainable", model.arithmetic_attainable},
          {"transfer_gb_s", model.transfer_gb_s},
          {"transfer_attainable", model.transfer_attainable},
          {"launch_us", model.launch_us},
          {"wait_us", model.wait_us},
          {"goal_ms", model.goal_ms == 0 ? Json(nullptr) : Json(model.goal_ms)}};
}

Json count_json(const FrameCount& count) {
  Json json = {{"frames", count.frames},           {"tracked", count.tracked},   {"edges_left", count.left_edges},
               {"edges_right", count.right_edges}, {"variants", count.variants}, {"stages", Json::array()}};
  for (const auto& stage : count.stages) {
    json["stages"].push_back({{"stage", stage.stage},
                              {"least_bytes", stage.work.bytes},
                              {"least_operations", stage.work.operations},
                              {"launches", stage.launches},
                              {"writes", stage.writes},
                              {"waits", stage.waits},
                              {"to_device_bytes", stage.to_device},
                              {"to_host_bytes", stage.to_host}});
  }
  return json;
}

Json estimate_json(const FrameEstimate& estimate) {
  Json json = {{"kind", "estimate, not measured"}, {"model", model_json(estimate.model)}, {"stages", Json::array()}};
  for (const auto& stage : estimate.stages) {
    json["stages"].push_back({{"stage", stage.stage},
                              {"estimate_ms", stage.total_ms()},
                              {"bound", stage.bound()},
                              {"memory_ms", stage.memory_ms},
                              {"arithmetic_ms", stage.arithmetic_ms},
                              {"launches_ms", stage.launches_ms},
                              {"waits_ms", stage.waits_ms},
                              {"transfers_ms", stage.transfers_ms}});
  }
  json["device_estimate_ms"] = estimate.device_ms();
  json["frame_estimate_ms"] = estimate.frame_ms();
  json["in_the_way"] = estimate.in_the_way();
  return json;
}

}  // namespace

std::string estimates_json(const DeviceInfo& device, const Config& config, const FrameCount& count,
                           const std::vector<FrameEstimate>& estimates, const std::string& command) {
  Json json;
  json["schema"] = kBenchSchema;
  report::add_origin(json, command);
  json["device"] = report::to_json(device);
  report::add_configuration(json, config);
  json["counted"] = count_json(count);
  json["host_measured_ms"] = count.host_ms;
  json["estimates"] = Json::array();
  for (const auto& estimate : estimates) json["estimates"].push_back(estimate_json(estimate));
  return report::json_text(json);
}

}  // namespace quadedge::bench
