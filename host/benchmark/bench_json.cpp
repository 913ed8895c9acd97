#include "benchmark/bench_record.hpp"
#include "report/json.hpp"
#include "report/json_values.hpp"
#include "report/statistics.hpp"

namespace quadedge::bench {

using report::Json;
using report::to_json;

double BenchRecord::frame_ratio() const {
  return report::latency_summary(run.frames).median /
         report::median(yardsticks ? yardsticks->sift_both_ms : std::vector<double>());
}

double BenchRecord::edges_ratio() const {
  return report::median(edges_ms) / report::median(yardsticks ? yardsticks->sepfilter_nine_ms : std::vector<double>());
}

std::string bench_json(const BenchRecord& record) {
  Json json = Json::parse(report::report_json(record.run));
  json["bench_schema"] = kBenchSchema;
  json["command"] = record.command;
  json["commit"] = *source_commit() == '\0' ? Json(nullptr) : Json(source_commit());
  json["frames_measured"] = record.run.frames.empty() ? 0 : static_cast<int>(record.run.frames.size()) - 1;
  json["warm_up"] = record.warm_up;
  json["threads"] = record.threads;
  json["edges_wanted"] = record.edges_wanted == 0 ? Json(nullptr) : Json(record.edges_wanted);
  json["edge_detection_ms"] = {{"median", to_json(report::median(record.edges_ms))},
                               {"p90", to_json(report::percentile(record.edges_ms, 0.9))}};
  json["waits_per_frame"] = record.waits;
  json["moved_mb_per_frame"] = {{"to_device", record.to_device_mb}, {"to_host", record.to_host_mb}};
  json["memory_mb"]["frames"] = record.frames_mb;
  if (record.yardsticks) {
    json["baseline"] = {{"opencv_sift_both_ms", to_json(report::median(record.yardsticks->sift_both_ms))},
                        {"opencv_sepfilter_nine_ms", to_json(report::median(record.yardsticks->sepfilter_nine_ms))},
                        {"threads", record.yardsticks->threads},
                        {"frame_ratio", to_json(record.frame_ratio())},
                        {"edges_ratio", to_json(record.edges_ratio())}};
  }
  return report::json_text(json);
}

}  // namespace quadedge::bench
