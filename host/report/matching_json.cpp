#include "report/matching_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "evaluation/matching_observer.hpp"
#include "quadedge/evaluate_matching.hpp"
#include "quadedge/tap.hpp"
#include "report/json_values.hpp"
#include "report/run_record.hpp"
#include "report/statistics.hpp"

namespace quadedge::report {
namespace {

/// Orders of the filters that take SIFT.
constexpr std::array<int, 2> kSiftStereo = {order_of(StereoFilter::sift), order_of(StereoFilter::nearly_best_sift)};
constexpr std::array<int, 2> kSiftTemporal = {order_of(TemporalFilter::sift),
                                              order_of(TemporalFilter::nearly_best_sift)};

/// A filter without a limit lets everything pass: the row is that of the filter before.
bool is_off(const std::vector<evaluation::PooledRow>& rows, std::size_t i, const std::array<int, 2>& sift) {
  if (i == 0 || std::find(sift.begin(), sift.end(), rows[i].row.order) == sift.end()) return false;
  const auto same = [](const evaluation::FilterCounts& a, const evaluation::FilterCounts& b) {
    return a.candidates == b.candidates && a.veridical == b.veridical && a.alive == b.alive;
  };
  return same(rows[i].row.paired, rows[i - 1].row.paired) && same(rows[i].row.all, rows[i - 1].row.all);
}

Json table(const std::vector<evaluation::PooledRow>& rows, bool all, const std::array<int, 2>& sift) {
  Json list = Json::array();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& pooled = rows[i];
    const auto& counts = all ? pooled.row.all : pooled.row.paired;
    const auto& spread = all ? pooled.all_std : pooled.paired_std;
    list.push_back({{"order", pooled.row.order},
                    {"filter", pooled.row.filter},
                    {"recall", to_json(counts.recall())},
                    {"precision", to_json(counts.precision())},
                    {"precision_per_edge", to_json(counts.precision_per_edge())},
                    {"ambiguity_mean", to_json(counts.ambiguity_mean())},
                    {"ambiguity_of_pool", to_json(counts.ambiguity_of_pool())},
                    {"ambiguity_max", to_json(counts.ambiguity_max())},
                    {"kept", counts.candidates},
                    {"edges", counts.pool},
                    {"recall_std", to_json(spread.recall)},
                    {"precision_std", to_json(spread.precision)},
                    {"ambiguity_std", to_json(spread.ambiguity)}});
    if (is_off(rows, i, sift)) list.back()["off"] = true;
  }
  return list;
}

Json quads(const evaluation::PooledQuads& quads) {
  return {{"recall", to_json(quads.counts.recall())},
          {"precision", to_json(quads.counts.precision())},
          {"edges", quads.counts.pool},
          {"kept", quads.counts.candidates},
          {"recall_std", to_json(quads.std.recall)},
          {"precision_std", to_json(quads.std.precision)},
          {"ambiguity_mean", to_json(quads.ambiguity_mean)},
          {"ambiguity_std", to_json(quads.std.ambiguity)}};
}

Json constraints(const evaluation::MatchingSummary& summary) {
  Json list = Json::array();
  const double first = static_cast<double>(summary.constraints[0].counts.veridical);
  for (std::size_t order = 0; order < summary.constraints.size(); ++order) {
    const auto& row = summary.constraints[order];
    const double veridical = static_cast<double>(row.counts.veridical);
    list.push_back({{"order", order},
                    {"constraint", evaluation::kConstraintNames[order]},
                    {"recall", to_json(veridical / first)},
                    {"precision", to_json(veridical / static_cast<double>(row.counts.pairs))},
                    {"pairs", row.counts.pairs},
                    {"recall_std", to_json(row.recall_std)},
                    {"precision_std", to_json(row.precision_std)}});
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
                    {"keeps_small", cue.keeps_small},
                    {"thresholds", cue.thresholds},
                    {"low", cue.veridical.low},
                    {"high", cue.veridical.high},
                    {"other_is_sample", cue.sampled},
                    {"veridical", histogram(cue.veridical)},
                    {"other", histogram(cue.other)}});
    if (cue.veridical_all.total() + cue.other_all.total() == 0) continue;
    list.back()["veridical_all"] = histogram(cue.veridical_all);
    list.back()["other_all"] = histogram(cue.other_all);
  }
  return list;
}

/// What the pairs of quads give after each constraint, in the order of the table of constraints.
Json pairs(const evaluation::PairMeasurement& measured) {
  Json list = Json::array();
  for (std::size_t order = 0; order < measured.table.size(); ++order) {
    const auto& counts = measured.table[order];
    list.push_back({{"precision", to_json(static_cast<double>(counts.veridical) / static_cast<double>(counts.pairs))},
                    {"rotation_error_deg", to_json(measured.accuracy[order].rotation_deg)},
                    {"translation_error_m", to_json(measured.accuracy[order].translation_m)}});
  }
  return list;
}

/// Found minus true disparity of the final stereo edges that are visible in both views [px].
Json disparity_errors(const std::vector<evaluation::MatchingResult>& results) {
  constexpr double kRange = 1.5;
  evaluation::Histogram errors(-kRange, kRange, 300);
  for (const auto& result : results) {
    for (const auto& frame : result.frames) {
      for (const float error : frame.disparity_error) errors.add(error);
    }
  }
  Json json = {{"low", errors.low}, {"high", errors.high}};
  json.update(histogram(errors));
  return json;
}

Json per_frame(const evaluation::MatchingResult& result) {
  Json list = Json::array();
  for (const auto& frame : result.frames) {
    Json entry = {{"status", to_string(frame.status)}};
    for (const auto& [name, count] : named_counts(frame.counts)) entry[name] = count;
    if (!frame.message.empty()) entry["message"] = frame.message;
    if (frame.motion) {
      entry["rotation_error_deg"] = frame.motion->rotation_deg;
      entry["translation_error_m"] = frame.motion->translation_m;
    }
    if (frame.temporal) entry["pairs"] = pairs(frame.temporal->pairs);
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
  json["stereo"] = table(summary.stereo, false, kSiftStereo);
  json["stereo_all"] = table(summary.stereo, true, kSiftStereo);
  json["disparity_error_px"] = {{"median", to_json(summary.disparity_median)},
                                {"p90", to_json(summary.disparity_p90)},
                                {"bias", to_json(summary.disparity_bias)}};
  json["across_error_px"] = {{"median", to_json(summary.across_median)}, {"p90", to_json(summary.across_p90)}};
  if (summary.temporal_frames > 0) {
    json["temporal_left"] = table(summary.temporal_left, false, kSiftTemporal);
    json["temporal_right"] = table(summary.temporal_right, false, kSiftTemporal);
    json["temporal_left_all"] = table(summary.temporal_left, true, kSiftTemporal);
    json["temporal_right_all"] = table(summary.temporal_right, true, kSiftTemporal);
    json["quads"] = quads(summary.quads_paired);
    json["quads_all"] = quads(summary.quads_all);
    json["constraints"] = constraints(summary);
  }
  return json;
}

}  // namespace

std::string matching_json(const std::vector<evaluation::MatchingResult>& results, const MatchingFacts& facts) {
  Json json;
  json["schema"] = kMatchingSchema;
  add_origin(json, facts.command);
  json["device"] = to_json(facts.device);
  json["input"] = facts.inputs;
  json["tolerance_px"] = facts.tolerance.position;
  json["wrong_px"] = facts.tolerance.wrong;
  add_configuration(json, facts.config);
  json["drawings"] = Json::array();
  for (const auto& drawing : facts.drawings)
    json["drawings"].push_back({{"name", drawing.name}, {"file", drawing.file}, {"caption", drawing.caption}});
  json["pairs"] = Json::array();
  for (const auto& result : results) {
    Json pair = {{"name", result.name}, {"frames", result.frames.size()}, {"counts", per_frame(result)}};
    pair.update(everything(evaluation::summarise({result})));
    json["pairs"].push_back(pair);
  }
  const auto summary = evaluation::summarise(results);
  json["pooled"] = everything(summary);
  json["pooled"]["distributions"] = distributions(summary.cues);
  json["pooled"]["disparity_error_histogram"] = disparity_errors(results);
  const MotionCorrelation correlation = motion_correlation(results);
  json["pooled"]["motion_rank_correlation"] = {{"points", correlation.points},
                                               {"rotation", to_json(correlation.rotation)},
                                               {"translation", to_json(correlation.translation)}};
  return json_text(json);
}

MotionCorrelation motion_correlation(const std::vector<evaluation::MatchingResult>& results) {
  std::vector<double> precisions, rotations, translations;
  for (std::size_t order = 0; order < evaluation::kConstraintNames.size(); ++order) {
    for (const auto& result : results) {
      for (const auto& frame : result.frames) {
        if (!frame.temporal) continue;
        const auto& counts = frame.temporal->pairs.table[order];
        const auto& error = frame.temporal->pairs.accuracy[order];
        if (counts.pairs == 0 || !std::isfinite(error.rotation_deg)) continue;
        precisions.push_back(static_cast<double>(counts.veridical) / static_cast<double>(counts.pairs));
        rotations.push_back(error.rotation_deg);
        translations.push_back(error.translation_m);
      }
    }
  }
  return {static_cast<int>(precisions.size()), rank_correlation(precisions, rotations),
          rank_correlation(precisions, translations)};
}

}  // namespace quadedge::report

namespace quadedge {
namespace {

std::string evaluate(const evaluation::MatchingSource& source, Device& device, const Config& config, int frames) {
  evaluation::MatchingOptions options;
  options.frames = frames;
  options.distributions = true;
  report::MatchingFacts facts;
  facts.inputs = {source.name()};
  facts.device = device.info();
  facts.config = config;
  return report::matching_json({evaluation::evaluate_matching(source, device, config, options)}, facts);
}

}  // namespace

std::string evaluate_matching(const Dataset& dataset, Device& device, const Config& config, int frames) {
  return evaluate(*evaluation::make_recorded_source(dataset), device, config, frames);
}

std::string evaluate_matching(const SyntheticOptions& scene, Device& device, const Config& config, int frames) {
  return evaluate(*evaluation::make_rendered_source(scene), device, config, frames);
}

}  // namespace quadedge
