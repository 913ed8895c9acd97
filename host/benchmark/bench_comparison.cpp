#include "benchmark/bench_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>

#include "benchmark/bench_record.hpp"
#include "quadedge/error.hpp"
#include "report/json_values.hpp"

namespace quadedge::bench {
namespace {

using report::Json;
using report::to_number;

constexpr double kSmallShare = 0.05;  // of the frame: stages below it are shown, not judged

Json read_result(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw DataError(file + ": cannot be read");
  Json json;
  try {
    json = Json::parse(stream);
  } catch (const Json::exception&) {
    throw DataError(file + ": this is no JSON; expected a result of `quadedge bench --json`");
  }
  if (!json.is_object() || !json.contains("bench_schema"))
    throw DataError(file + ": expected a result of `quadedge bench --json`");
  if (json["bench_schema"] != kBenchSchema) {
    throw DataError(file + ": has schema " + json["bench_schema"].dump() + ", this program compares schema " +
                    std::to_string(kBenchSchema));
  }
  return json;
}

void require_equal(const Json& before, const Json& after, const char* pointer, const std::string& old_file,
                   const std::string& new_file) {
  const Json::json_pointer key(pointer);
  if (before.at(key) == after.at(key)) return;
  throw DataError(new_file + " and " + old_file + " cannot be compared: " + std::string(pointer + 1) + " is " +
                  after.at(key).dump() + ", and was " + before.at(key).dump());
}

/// Collects figures of both results.
class Figures {
 public:
  Figures(const Json& before, const Json& after, double noise_percent, BenchComparison& result)
      : before_(before), after_(after), noise_(noise_percent), result_(result) {}

  void time(const std::string& name, const std::string& pointer, bool judged) {
    add(name, required(before_, pointer), required(after_, pointer), judged, result_.drift);
  }
  void size(const std::string& name, const std::string& pointer) {
    add(name, required(before_, pointer), required(after_, pointer), true, 1);
  }
  /// The medians of every stage of a table.
  void stages(const std::string& label, const std::string& table, double frame_ms) {
    std::set<std::string> names;
    for (const Json* json : {&before_, &after_}) {
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
  static double required(const Json& json, const std::string& pointer) {
    return to_number(json.at(Json::json_pointer(pointer)));
  }
  /// NaN for a stage that one of the results does not have.
  static double value(const Json& json, const std::string& pointer) {
    const Json::json_pointer key(pointer);
    return json.contains(key) ? to_number(json.at(key)) : std::numeric_limits<double>::quiet_NaN();
  }
  void add(const std::string& name, double before, double after, bool judged, double drift) {
    ComparedFigure figure;
    figure.name = name;
    figure.before = before;
    figure.after = after;
    figure.change_percent = figure.before == 0 ? (figure.after == 0 ? 0 : std::numeric_limits<double>::quiet_NaN())
                                               : 100 * (figure.after / drift / figure.before - 1);
    figure.judged = judged && std::isfinite(figure.change_percent);
    figure.worse = figure.judged && figure.change_percent > noise_;
    result_.figures.push_back(figure);
  }

  const Json& before_;
  const Json& after_;
  double noise_;
  BenchComparison& result_;
};

void compare_lost_frames(const Json& before, const Json& after, BenchComparison& result) {
  ComparedFigure lost;
  lost.name = "lost frames";
  lost.before = to_number(before.at("frames_lost"));
  lost.after = to_number(after.at("frames_lost"));
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
  const Json before = read_result(old_file), after = read_result(new_file);
  BenchComparison result;
  try {
    for (const char* key : {"/device/name", "/device/platform", "/input/name", "/input/width", "/input/height"}) {
      require_equal(before, after, key, old_file, new_file);
    }
    if (before.contains("baseline") && after.contains("baseline")) {
      result.drift = to_number(after["baseline"].at("opencv_sift_both_ms")) /
                     to_number(before["baseline"].at("opencv_sift_both_ms"));
    }
    const double frame_ms = to_number(before.at("latency_ms").at("median"));
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
    note_differences(before, after, result);
  } catch (const Json::exception& error) {
    throw DataError(new_file + " or " + old_file + " is incomplete: " + error.what());
  }
  return result;
}

}  // namespace quadedge::bench
