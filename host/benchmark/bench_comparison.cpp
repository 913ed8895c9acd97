#include "benchmark/bench_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "benchmark/bench_record.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"
#include "report/json.hpp"
#include "report/json_values.hpp"

namespace quadedge::bench {
namespace {

using report::Json;

constexpr double kSmallShare = 0.05;  // of the frame; smaller stages are printed but not judged

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
  Result result{file, {}};
  constexpr const char* kExpected = "a result of `quadedge bench --json`";
  try {
    result.json = Json::parse(data::read_text(file));
  } catch (const Json::exception&) {
    data::fail(file, "no JSON", kExpected);
  }
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

/// Collects figures of both results.
class Figures {
 public:
  Figures(const Result& before, const Result& after, double noise_percent, BenchComparison& result)
      : before_(before), after_(after), noise_(noise_percent), result_(result) {}

  void time(const std::string& name, const std::string& pointer, bool judged) {
    add(name, figure(before_, pointer), figure(after_, pointer), judged, result_.drift);
  }
  void size(const std::string& name, const std::string& pointer) {
    add(name, figure(before_, pointer), figure(after_, pointer), true, 1);
  }
  /// Adds the medians of every stage of a table.
  void stages(const std::string& label, const std::string& table, double frame_ms) {
    std::set<std::string> names;
    for (const Json* json : {&before_.json, &after_.json}) {
      if (!json->contains(table)) continue;
      for (const auto& [stage, unused] : json->at(table).items()) {
        (void)unused;
        if (!names.insert(stage).second) continue;
        const std::string pointer = "/" + table + "/" + stage + "/median";
        const double before = value(before_, pointer);
        add(label + " " + stage + " [ms]", before, value(after_, pointer), before >= kSmallShare * frame_ms,
            result_.drift);
      }
    }
  }

 private:
  /// NaN for a stage that is missing in one of the results.
  static double value(const Result& result, const std::string& pointer) {
    const bool there = result.json.contains(Json::json_pointer(pointer));
    return there ? figure(result, pointer) : std::numeric_limits<double>::quiet_NaN();
  }
  void add(const std::string& name, double before, double after, bool judged, double drift) {
    ComparedFigure compared;
    compared.name = name;
    compared.before = before;
    compared.after = after;
    compared.change_percent = before == 0 && after == 0 ? 0 : 100 * (after / drift / before - 1);
    compared.judged = judged && !std::isnan(compared.change_percent);
    compared.worse = compared.judged && compared.change_percent > noise_;
    result_.figures.push_back(compared);
  }

  const Result& before_;
  const Result& after_;
  double noise_;
  BenchComparison& result_;
};

void compare_lost_frames(const Result& before, const Result& after, BenchComparison& result) {
  ComparedFigure lost;
  lost.name = "lost frames";
  lost.before = figure(before, "/frames_lost");
  lost.after = figure(after, "/frames_lost");
  lost.change_percent = std::numeric_limits<double>::quiet_NaN();
  lost.judged = true;
  lost.worse = lost.after > lost.before;
  result.figures.push_back(lost);
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
    const double frame_ms = positive_figure(before, "/latency_ms/median");
    Figures figures(before, after, noise_percent, result);
    figures.time("frame, median [ms]", "/latency_ms/median", true);
    figures.time("frame, p90 [ms]", "/latency_ms/p90", true);
    figures.time("frame, p99 [ms]", "/latency_ms/p99", false);
    figures.time("frame, max [ms]", "/latency_ms/max", false);
    figures.time("first frame [ms]", "/latency_ms/first", false);
    figures.time("edge detection, one image [ms]", "/edge_detection_ms/median", true);
    figures.stages("host", "stages_ms", frame_ms);
    figures.stages("kernels", "kernels_ms", frame_ms);
    figures.time("start-up [ms]", "/start_ms/total", false);
    figures.time("kernel build [ms]", "/start_ms/kernel_build", false);
    figures.size("host memory, peak [MB]", "/memory_mb/host_peak");
    figures.size("device memory, peak [MB]", "/memory_mb/device_peak");
    figures.size("to the device, per frame [MB]", "/moved_mb_per_frame/to_device");
    figures.size("to the host, per frame [MB]", "/moved_mb_per_frame/to_host");
    compare_lost_frames(before, after, result);
    note_differences(before.json, after.json, result);
  } catch (const Json::exception& error) {
    throw DataError(new_file + " or " + old_file + " is incomplete: " + error.what());
  }
  return result;
}

}  // namespace quadedge::bench
