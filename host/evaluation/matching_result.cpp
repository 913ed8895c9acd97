#include "evaluation/matching_result.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/numeric.hpp"

namespace quadedge::evaluation {
namespace {

/// Standard deviation of the finite values; NaN for fewer than two.
double deviation(const std::vector<double>& values) {
  double count = 0, sum = 0, squares = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    ++count;
    sum += value;
  }
  for (const double value : values) {
    if (std::isfinite(value)) squares += (value - sum / count) * (value - sum / count);
  }
  return count > 1 ? std::sqrt(squares / count) : std::numeric_limits<double>::quiet_NaN();
}

/// Quantile of values in any order; NaN if there are none.
double quantile(std::vector<float> values, double fraction) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto rank = static_cast<std::ptrdiff_t>(std::lround(fraction * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

/// Recall, precision and ambiguity of individual frames.
struct FrameValues {
  std::vector<double> recall, precision, ambiguity;
  void add(const FilterCounts& counts) { add(counts.recall(), counts.precision(), counts.ambiguity_mean()); }
  void add(double recall_value, double precision_value, double ambiguity_value) {
    recall.push_back(recall_value);
    precision.push_back(precision_value);
    ambiguity.push_back(ambiguity_value);
  }
  FilterSpread spread() const { return {deviation(recall), deviation(precision), deviation(ambiguity)}; }
};

std::vector<PooledRow> pool(const std::vector<const FilterTable*>& tables) {
  FilterTable sum;
  for (const auto* table : tables) add(sum, *table);
  std::vector<PooledRow> rows;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    FrameValues paired, all;
    for (const auto* table : tables) {
      paired.add((*table)[i].paired);
      all.add((*table)[i].all);
    }
    rows.push_back({sum[i], paired.spread(), all.spread()});
  }
  return rows;
}

/// The quads of one pool, of all frames with temporal matching.
PooledQuads pool_quads(const std::vector<const TemporalMatching*>& frames, FilterCounts TemporalMatching::*quads,
                       std::int64_t TemporalMatching::*competing) {
  PooledQuads pooled;
  FrameValues values;
  std::int64_t all_competing = 0;
  for (const auto* frame : frames) {
    const FilterCounts& counts = frame->*quads;
    pooled.counts.add(counts);
    all_competing += frame->*competing;
    values.add(counts.recall(), counts.precision(), ratio(frame->*competing, counts.candidates));
  }
  pooled.std = values.spread();
  pooled.ambiguity_mean = ratio(all_competing, pooled.counts.candidates);
  return pooled;
}

void pool_constraints(const std::vector<const TemporalMatching*>& frames, MatchingSummary& summary) {
  for (std::size_t order = 0; order < summary.constraints.size(); ++order) {
    PooledConstraint& row = summary.constraints[order];
    std::vector<double> recall, precision;
    for (const auto* frame : frames) {
      const ConstraintCounts& counts = frame->pairs.table[order];
      row.counts.pairs += counts.pairs;
      row.counts.veridical += counts.veridical;
      recall.push_back(ratio(counts.veridical, frame->pairs.table[0].veridical));
      precision.push_back(ratio(counts.veridical, counts.pairs));
    }
    row.recall_std = deviation(recall);
    row.precision_std = deviation(precision);
  }
}

void add(EdgeCensus& sum, const EdgeCensus& census) {
  sum.edges += census.edges;
  sum.no_statement += census.no_statement;
  sum.along_line += census.along_line;
  sum.occluded += census.occluded;
  sum.contour += census.contour;
}

}  // namespace

MatchingSummary summarise(const std::vector<MatchingResult>& results) {
  MatchingSummary summary;
  std::vector<const FilterTable*> stereo, temporal_left, temporal_right;
  std::vector<const TemporalMatching*> matched_in_time;
  std::vector<float> errors, absolute, across;
  for (const auto& result : results) {
    add(summary.cues, result.cues);
    for (const auto& frame : result.frames) {
      ++summary.frames;
      add(summary.census, frame.census);
      for (std::size_t kind = 0; kind < frame.classes.size(); ++kind) summary.classes[kind] += frame.classes[kind];
      if (!frame.stereo.empty()) stereo.push_back(&frame.stereo);
      errors.insert(errors.end(), frame.disparity_error.begin(), frame.disparity_error.end());
      across.insert(across.end(), frame.across_error.begin(), frame.across_error.end());
      if (!frame.temporal) continue;
      ++summary.temporal_frames;
      temporal_left.push_back(&frame.temporal->left);
      temporal_right.push_back(&frame.temporal->right);
      matched_in_time.push_back(&*frame.temporal);
    }
  }
  summary.stereo = pool(stereo);
  summary.temporal_left = pool(temporal_left);
  summary.temporal_right = pool(temporal_right);
  summary.quads_paired =
      pool_quads(matched_in_time, &TemporalMatching::quads_paired, &TemporalMatching::competing_paired);
  summary.quads_all = pool_quads(matched_in_time, &TemporalMatching::quads_all, &TemporalMatching::competing_all);
  pool_constraints(matched_in_time, summary);
  for (const float error : errors) absolute.push_back(std::abs(error));
  summary.disparity_median = quantile(absolute, 0.5);
  summary.disparity_p90 = quantile(absolute, 0.9);
  summary.disparity_bias = quantile(errors, 0.5);
  summary.across_median = quantile(across, 0.5);
  summary.across_p90 = quantile(across, 0.9);
  return summary;
}

}  // namespace quadedge::evaluation
