#include "benchmark/bench_record.hpp"
#include "benchmark/variant_comparison.hpp"
#include "report/json_values.hpp"

namespace quadedge::bench {

std::string comparison_json(const DeviceInfo& device, const Ceilings& ceilings, const std::vector<StageResult>& stages,
                            const std::string& command) {
  using report::Json;
  using report::to_json;
  Json json;
  json["schema"] = kBenchSchema;
  report::add_origin(json, command);
  json["device"] = report::to_json(device);
  json["ceilings"] = {{"bandwidth_gb_s", ceilings.bandwidth_gb_s}, {"arithmetic_gflop_s", ceilings.arithmetic_gflop_s}};
  json["stages"] = Json::array();
  for (const auto& stage : stages) {
    Json rows = Json::array();
    for (const auto& variant : stage.variants) {
      rows.push_back({{"name", variant.name},
                      {"default", variant.is_default},
                      {"agrees", variant.agrees},
                      {"why", variant.why},
                      {"median_ms", to_json(variant.median_ms)},
                      {"p10_ms", to_json(variant.p10_ms)},
                      {"p90_ms", to_json(variant.p90_ms)},
                      {"ratio_to_default", to_json(variant.ratio_to_default)},
                      {"ratio_p90", to_json(variant.ratio_p90)},
                      {"bandwidth_share", to_json(variant.bandwidth_share)},
                      {"arithmetic_share", to_json(variant.arithmetic_share)}});
    }
    json["stages"].push_back({{"stage", stage.stage}, {"best", stage.best()}, {"variants", rows}});
  }
  return report::json_text(json);
}

}  // namespace quadedge::bench
