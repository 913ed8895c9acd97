/// \file bench_record.cpp  Writes results as JSON; compares two figure by figure, times relative to a yardstick.
#include "benchmark/bench_record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "data/text.hpp"
#include "output/json.hpp"
#include "output/json_values.hpp"
#include "output/statistics.hpp"
#include "quadedge/error.hpp"

namespace quadedge::bench {
namespace {

using report::Json;

constexpr double kSmallShare = 0.05;  // of the frame; smaller stages are printed but not judged

/// Every stage's times and its percentage of the frame; the host's rest last.
Json shares_json(const FrameShares& shares) {
  const auto percent = [&](double ms) { return 100 * ms / shares.frame_ms; };
  Json json = {{"frame_ms", shares.frame_ms}, {"stages", Json::object()}};
  for (const auto& stage : shares.stages) {
    json["stages"][stage.stage] = {{"wall_ms", stage.wall_ms()},   {"percent", percent(stage.wall_ms())},
                                   {"kernel_ms", stage.kernel_ms}, {"transfer_ms", stage.transfer_ms},
                                   {"queue_ms", stage.queue_ms},   {"launches", stage.launches}};
  }
  json["host"] = {{"wall_ms", shares.host_ms()}, {"percent", percent(shares.host_ms())}};
  return json;
}

/// A result and its file.
struct Result {
  std::string file;
  Json json;
};

void require_schema(const Result& result, const char* key, int known) {
  if (result.json.contains(key) && result.json[key] == known) return;
  const std::string found = result.json.contains(key) ? result.json[key].dump() : "none";
  data::fail(result.file, std::string(key) + " " + found, std::to_string(known) + ", which this program compares");
}

Result read_result(const std::string& file) {
  constexpr const char* kExpected = "a result of `quadedge bench --json`";
  Result result{file, report::read_json(file, kExpected)};
  if (!result.json.is_object() || !result.json.contains("bench_schema")) data::fail(file, "other JSON", kExpected);
  require_schema(result, "bench_schema", kBenchSchema);
  require_schema(result, "schema", report::kReportSchema);
  return result;
}

/// A figure that every result has. \throws DataError if it is missing or not a number of 0 or more, because a
/// regression could not be detected then.
double figure(const Result& result, const std::string& pointer) {
  const Json::json_pointer key(pointer);
  const Json value = result.json.contains(key) ? result.json.at(key) : Json("none");
  if (value.is_number() && std::isfinite(value.get<double>()) && value.get<double>() >= 0) return value.get<double>();
  data::fail(result.file, pointer.substr(1) + " " + value.dump(), "a number of 0 or more");
}

/// A time used as a reference for others.
double positive_figure(const Result& result, const std::string& pointer) {
  const double value = figure(result, pointer);
  if (!(value > 0)) data::fail(result.file, pointer.substr(1) + " 0", "more than 0");
  return value;
}

void require_equal(const Result& before, const Result& after, const char* pointer) {
  const Json::json_pointer key(pointer);
  if (before.json.at(key) == after.json.at(key)) return;
  throw DataError(after.file + " and " + before.file + " cannot be compared: " + std::string(pointer + 1) + " is " +
                  after.json.at(key).dump() + ", and was " + before.json.at(key).dump());
}

/// A figure that every result has. Times are corrected for the machine's drift.
struct Row {
  const char* name;
  const char* pointer;
  bool is_judged, is_time;
};

constexpr Row kRows[] = {
    {"frame, median [ms]", "/latency_ms/median", true, true},
    {"frame, p90 [ms]", "/latency_ms/p90", true, true},
    {"frame, p99 [ms]", "/latency_ms/p99", false, true},
    {"frame, max [ms]", "/latency_ms/max", false, true},
    {"first frame [ms]", "/latency_ms/first", false, true},
    {"edge detection, one image [ms]", "/edge_detection_ms/median", true, true},
    {"start-up [ms]", "/start_ms/total", false, true},
    {"kernel build [ms]", "/start_ms/kernel_build", false, true},
    {"host memory, peak [MB]", "/memory_mb/host_peak", true, false},
    {"device memory, peak [MB]", "/memory_mb/device_peak", true, false},
    {"to the device, per frame [MB]", "/moved_mb_per_frame/to_device", true, false},
    {"to the host, per frame [MB]", "/moved_mb_per_frame/to_host", true, false},
};

ComparedFigure compared(const std::string& name, double before, double after, bool judged, double noise, double drift) {
  ComparedFigure figure{name, before, after};
  figure.change_percent = before == 0 && after == 0 ? 0 : 100 * (after / drift / before - 1);
  figure.judged = judged && !std::isnan(figure.change_percent);
  figure.worse = figure.judged && figure.change_percent > noise;
  return figure;
}

/// The medians of all stages of a table.
void compare_stages(const Result& before, const Result& after, const std::string& table, double noise,
                    BenchComparison& result) {
  std::set<std::string> names;
  for (const Json* json : {&before.json, &after.json}) {
    if (!json->contains(table)) continue;
    for (const auto& item : json->at(table).items()) names.insert(item.key());
  }
  const double small = kSmallShare * figure(before, "/latency_ms/median");
  for (const auto& name : names) {
    const std::string pointer = "/" + table + "/" + name + "/median";
    const auto value = [&](const Result& of) {  // NaN for a stage that is missing in one of the results
      return of.json.contains(Json::json_pointer(pointer)) ? figure(of, pointer)
                                                           : std::numeric_limits<double>::quiet_NaN();
    };
    const std::string label = (table == "kernels_ms" ? "kernels " : "host ") + name + " [ms]";
    result.figures.push_back(compared(label, value(before), value(after), value(before) >= small, noise, result.drift));
  }
}

void note_differences(const Json& before, const Json& after, BenchComparison& result) {
  for (const char* key : {"version", "commit", "command", "threads", "frames_measured"}) {
    if (before.at(key) == after.at(key)) continue;
    result.notes.push_back(std::string(key) + ": " + before.at(key).dump() + " -> " + after.at(key).dump());
  }
  for (const char* table : {"variants", "config", "counts", "device"}) {
    const Json old_values = before.at(table).flatten(), new_values = after.at(table).flatten();
    for (const auto& [key, value] : new_values.items()) {
      const Json old_value = old_values.contains(key) ? old_values.at(key) : Json(nullptr);
      if (old_value != value) result.notes.push_back(table + key + ": " + old_value.dump() + " -> " + value.dump());
    }
  }
}

}  // namespace

double FrameShares::host_ms() const {
  double device = 0;
  for (const auto& stage : stages) device += stage.wall_ms();
  return frame_ms - device;
}

FrameShares BenchRecord::shares() const {
  FrameShares mean;
  if (profiled.empty()) return mean;
  const double scale = 1 / static_cast<double>(profiled.size());
  for (const auto& frame : profiled) {
    mean.frame_ms += frame.frame_ms * scale;
    for (const auto& stage : frame.stages) {
      std::size_t row = 0;
      while (row < mean.stages.size() && mean.stages[row].stage != stage.stage) ++row;
      if (row == mean.stages.size()) mean.stages.emplace_back().stage = stage.stage;
      mean.stages[row].kernel_ms += stage.kernel_ms * scale;
      mean.stages[row].transfer_ms += stage.transfer_ms * scale;
      mean.stages[row].queue_ms += stage.queue_ms * scale;
      mean.stages[row].launches += stage.launches * scale;
    }
  }
  return mean;
}

double BenchRecord::frame_ratio() const {
  return report::latency_summary(run.frames).median /
         report::median(yardsticks ? yardsticks->sift_both_ms : std::vector<double>());
}

double BenchRecord::edges_ratio() const {
  return report::median(edges_ms) / report::median(yardsticks ? yardsticks->sepfilter_nine_ms : std::vector<double>());
}

std::string bench_json(const BenchRecord& record) {
  Json json = Json::parse(report::report_json(record.run));
  report::add_origin(json, record.command);
  json["bench_schema"] = kBenchSchema;
  json["frames_measured"] = record.run.frames.empty() ? 0 : static_cast<int>(record.run.frames.size()) - 1;
  json["warm_up"] = record.warm_up;
  json["threads"] = record.threads;
  json["edges_wanted"] = record.edges_wanted == 0 ? Json(nullptr) : Json(record.edges_wanted);
  json["edge_detection_ms"] = {{"median", report::median(record.edges_ms)},
                               {"p90", report::percentile(record.edges_ms, 0.9)}};
  json["waits_per_frame"] = record.waits;
  json["launches_per_frame"] = record.launches;
  json["writes_per_frame"] = record.writes;
  json["processor_ms"] = {{"median", report::median(record.processor_ms)},
                          {"p90", report::percentile(record.processor_ms, 0.9)}};
  if (!record.profiled.empty()) json["shares"] = shares_json(record.shares());
  json["moved_mb_per_frame"] = {{"to_device", record.to_device_mb}, {"to_host", record.to_host_mb}};
  json["memory_mb"]["frames"] = record.frames_mb;
  if (record.yardsticks) {
    json["baseline"] = {{"opencv_sift_both_ms", report::median(record.yardsticks->sift_both_ms)},
                        {"opencv_sepfilter_nine_ms", report::median(record.yardsticks->sepfilter_nine_ms)},
                        {"threads", record.yardsticks->threads},
                        {"frame_ratio", record.frame_ratio()},
                        {"edges_ratio", record.edges_ratio()}};
  }
  return report::json_text(json);
}

bool BenchComparison::regressed() const {
  return std::any_of(figures.begin(), figures.end(), [](const ComparedFigure& figure) { return figure.worse; });
}

BenchComparison compare_benchmarks(const std::string& old_file, const std::string& new_file, double noise_percent) {
  const Result before = read_result(old_file), after = read_result(new_file);
  BenchComparison result;
  try {
    for (const char* key : {"/device/name", "/device/platform", "/input/name", "/input/width", "/input/height"}) {
      require_equal(before, after, key);
    }
    result.has_yardsticks = before.json.contains("baseline") && after.json.contains("baseline");
    if (result.has_yardsticks) {
      constexpr const char* kYardstick = "/baseline/opencv_sift_both_ms";
      result.drift = positive_figure(after, kYardstick) / positive_figure(before, kYardstick);
    }
    positive_figure(before, "/latency_ms/median");
    for (const Row& row : kRows) {
      result.figures.push_back(compared(row.name, figure(before, row.pointer), figure(after, row.pointer),
                                        row.is_judged, noise_percent, row.is_time ? result.drift : 1));
    }
    compare_stages(before, after, "stages_ms", noise_percent, result);
    compare_stages(before, after, "kernels_ms", noise_percent, result);
    ComparedFigure lost{"lost frames", figure(before, "/frames_lost"), figure(after, "/frames_lost")};
    lost.change_percent = std::numeric_limits<double>::quiet_NaN();
    lost.judged = true;
    lost.worse = lost.after > lost.before;
    result.figures.push_back(lost);
    note_differences(before.json, after.json, result);
  } catch (const Json::exception& error) {
    throw DataError(new_file + " or " + old_file + " is incomplete: " + error.what());
  }
  return result;
}

}  // namespace quadedge::bench
