#include "report/matching_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace quadedge::report {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no NaN: a value that does not exist is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json table(const std::vector<evaluation::PooledRow>& rows, bool all) {
  Json list = Json::array();
  for (const auto& pooled : rows) {
    const auto& counts = all ? pooled.row.all : pooled.row.paired;
    list.push_back({{"order", pooled.row.order},
                    {"filter", pooled.row.filter},
                    {"recall", number(counts.recall())},
                    {"precision", number(counts.precision())},
                    {"ambiguity_mean", number(counts.ambiguity_mean())},
                    {"ambiguity_max", number(counts.ambiguity_max())},
                    {"kept", counts.candidates},
                    {"edges", counts.pool},
                    {"recall_std", number(all ? pooled.all_recall_std : pooled.paired_recall_std)},
                    {"precision_std", number(all ? pooled.all_precision_std : pooled.paired_precision_std)}});
  }
  return list;
}

Json quads(const evaluation::FilterCounts& counts) {
  return {{"recall", number(counts.recall())}, {"precision", number(counts.precision())}, {"edges", counts.pool}, {"kept", counts.candidates}};
}

Json constraints(const evaluation::ConstraintTable& table) {
  Json list = Json::array();
  const double first = static_cast<double>(table[0].veridical);
  for (std::size_t order = 0; order < table.size(); ++order) {
    const double veridical = static_cast<double>(table[order].veridical);
    list.push_back({{"order", order},
                    {"constraint", evaluation::kConstraintNames[order]},
                    {"recall", number(veridical / first)},
                    {"precision", number(veridical / static_cast<double>(table[order].pairs))}});
  }
  return list;
}

Json everything(const evaluation::MatchingSummary& summary) {
  Json json;
  json["left_edges"] = {{"detected", summary.census.edges},     {"no_statement", summary.census.no_statement},
                        {"along_line", summary.census.along_line}, {"hidden", summary.census.hidden},
                        {"contour", summary.census.contour}};
  json["stereo"] = table(summary.stereo, false);
  json["stereo_all"] = table(summary.stereo, true);
  json["disparity_error_px"] = {{"median", number(summary.disparity_median)}, {"p90", number(summary.disparity_p90)},
                                {"bias", number(summary.disparity_bias)}};
  json["across_error_px"] = {{"median", number(summary.across_median)}, {"p90", number(summary.across_p90)}};
  if (summary.temporal_frames > 0) {
    json["temporal_left"] = table(summary.temporal_left, false);
    json["temporal_right"] = table(summary.temporal_right, false);
    json["temporal_left_all"] = table(summary.temporal_left, true);
    json["temporal_right_all"] = table(summary.temporal_right, true);
    json["quads"] = quads(summary.quads_paired);
    json["quads"]["ambiguity_mean"] = number(summary.quads_ambiguity_mean);
    json["quads_all"] = quads(summary.quads_all);
    json["constraints"] = constraints(summary.constraints);
  }
  return json;
}

}  // namespace

std::string matching_json(const std::vector<evaluation::MatchingResult>& results) {
  Json json;
  json["pairs"] = Json::array();
  for (const auto& result : results) {
    Json pair = {{"name", result.name}, {"frames", result.frames.size()}};
    pair.update(everything(evaluation::summarise({result})));
    json["pairs"].push_back(pair);
  }
  json["pooled"] = everything(evaluation::summarise(results));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace quadedge::report
