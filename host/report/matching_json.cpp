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
    const auto& spread = all ? pooled.all_std : pooled.paired_std;
    list.push_back({{"order", pooled.row.order},
                    {"filter", pooled.row.filter},
                    {"recall", number(counts.recall())},
                    {"precision", number(counts.precision())},
                    {"ambiguity_mean", number(counts.ambiguity_mean())},
                    {"ambiguity_max", number(counts.ambiguity_max())},
                    {"kept", counts.candidates},
                    {"edges", counts.pool},
                    {"recall_std", number(spread.recall)},
                    {"precision_std", number(spread.precision)},
                    {"ambiguity_std", number(spread.ambiguity)}});
  }
  return list;
}

Json quads(const evaluation::PooledQuads& quads) {
  return {{"recall", number(quads.counts.recall())},
          {"precision", number(quads.counts.precision())},
          {"edges", quads.counts.pool},
          {"kept", quads.counts.candidates},
          {"recall_std", number(quads.std.recall)},
          {"precision_std", number(quads.std.precision)}};
}

Json constraints(const evaluation::MatchingSummary& summary) {
  Json list = Json::array();
  const double first = static_cast<double>(summary.constraints[0].counts.veridical);
  for (std::size_t order = 0; order < summary.constraints.size(); ++order) {
    const auto& row = summary.constraints[order];
    const double veridical = static_cast<double>(row.counts.veridical);
    list.push_back({{"order", order},
                    {"constraint", evaluation::kConstraintNames[order]},
                    {"recall", number(veridical / first)},
                    {"precision", number(veridical / static_cast<double>(row.counts.pairs))},
                    {"pairs", row.counts.pairs},
                    {"recall_std", number(row.recall_std)},
                    {"precision_std", number(row.precision_std)}});
  }
  return list;
}

Json histogram(const evaluation::Histogram& histogram) {
  return {{"below", histogram.below}, {"bins", histogram.bins}, {"above", histogram.above}};
}

Json distributions(const std::vector<evaluation::CueDistribution>& cues) {
  Json list = Json::array();
  for (const auto& cue : cues) {
    if (cue.veridical.total() + cue.other.total() == 0) continue;
    list.push_back({{"table", evaluation::kCueTableNames[static_cast<std::size_t>(cue.table)]},
                    {"order", cue.order},
                    {"cue", cue.cue},
                    {"unit", cue.unit},
                    {"thresholds", cue.thresholds},
                    {"low", cue.veridical.low},
                    {"high", cue.veridical.high},
                    {"other_is_sample", cue.sampled},
                    {"veridical", histogram(cue.veridical)},
                    {"other", histogram(cue.other)}});
  }
  return list;
}

Json per_frame(const evaluation::MatchingResult& result) {
  Json list = Json::array();
  for (const auto& frame : result.frames) {
    Json entry = {{"status", to_string(frame.status)},
                  {"edges_left", frame.counts.edges_left},
                  {"edges_right", frame.counts.edges_right},
                  {"stereo_edges", frame.counts.stereo_edges},
                  {"temporal_left", frame.counts.temporal_left},
                  {"temporal_right", frame.counts.temporal_right},
                  {"quads", frame.counts.quads},
                  {"inliers", frame.counts.inliers}};
    if (!frame.message.empty()) entry["message"] = frame.message;
    if (frame.motion) {
      entry["rotation_error_deg"] = frame.motion->rotation_deg;
      entry["translation_error_m"] = frame.motion->translation_m;
    }
    list.push_back(entry);
  }
  return list;
}

Json everything(const evaluation::MatchingSummary& summary) {
  Json json;
  json["left_edges"] = {{"detected", summary.census.edges},
                        {"no_statement", summary.census.no_statement},
                        {"along_line", summary.census.along_line},
                        {"occluded", summary.census.occluded},
                        {"contour", summary.census.contour}};
  for (std::size_t kind = 0; kind < summary.classes.size(); ++kind) {
    json["stereo_edges"][evaluation::kMatchClassNames[kind]] = summary.classes[kind];
  }
  json["stereo"] = table(summary.stereo, false);
  json["stereo_all"] = table(summary.stereo, true);
  json["disparity_error_px"] = {{"median", number(summary.disparity_median)},
                                {"p90", number(summary.disparity_p90)},
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
    json["constraints"] = constraints(summary);
  }
  return json;
}

}  // namespace

std::string matching_json(const std::vector<evaluation::MatchingResult>& results) {
  Json json;
  json["pairs"] = Json::array();
  for (const auto& result : results) {
    Json pair = {{"name", result.name}, {"frames", result.frames.size()}, {"counts", per_frame(result)}};
    pair.update(everything(evaluation::summarise({result})));
    json["pairs"].push_back(pair);
  }
  const auto summary = evaluation::summarise(results);
  json["pooled"] = everything(summary);
  json["pooled"]["distributions"] = distributions(summary.cues);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace quadedge::report
