#include "evaluation/matching_result.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadedge::evaluation {
namespace {

/// Standard deviation of the finite values; NaN without any.
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
  return count > 0 ? std::sqrt(squares / count) : std::numeric_limits<double>::quiet_NaN();
}

/// Quantile of values in any order; NaN without any.
double quantile(std::vector<float> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

std::vector<PooledRow> pool(const std::vector<const FilterTable*>& tables) {
  FilterTable sum;
  for (const auto* table : tables) add(sum, *table);
  std::vector<PooledRow> rows;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    std::vector<double> paired_recall, paired_precision, all_recall, all_precision;
    for (const auto* table : tables) {
      paired_recall.push_back((*table)[i].paired.recall());
      paired_precision.push_back((*table)[i].paired.precision());
      all_recall.push_back((*table)[i].all.recall());
      all_precision.push_back((*table)[i].all.precision());
    }
    rows.push_back({sum[i], deviation(paired_recall), deviation(paired_precision), deviation(all_recall), deviation(all_precision)});
  }
  return rows;
}

}  // namespace

MatchingSummary summarise(const std::vector<MatchingResult>& results) {
  MatchingSummary summary;
  std::vector<const FilterTable*> stereo, temporal_left, temporal_right;
  std::vector<float> errors, absolute, across;
  std::int64_t rivals = 0;
  for (const auto& result : results) {
    for (const auto& frame : result.frames) {
      ++summary.frames;
      summary.census.edges += frame.census.edges;
      summary.census.no_statement += frame.census.no_statement;
      summary.census.along_line += frame.census.along_line;
      summary.census.hidden += frame.census.hidden;
      summary.census.contour += frame.census.contour;
      if (!frame.stereo.empty()) stereo.push_back(&frame.stereo);
      if (!frame.temporal_left.empty()) {
        ++summary.temporal_frames;
        temporal_left.push_back(&frame.temporal_left);
        temporal_right.push_back(&frame.temporal_right);
      }
      summary.quads_paired.add(frame.quads_paired);
      summary.quads_all.add(frame.quads_all);
      rivals += frame.quad_rivals;
      for (std::size_t i = 0; i < frame.constraints.size(); ++i) {
        summary.constraints[i].pairs += frame.constraints[i].pairs;
        summary.constraints[i].veridical += frame.constraints[i].veridical;
      }
      errors.insert(errors.end(), frame.disparity_error.begin(), frame.disparity_error.end());
      across.insert(across.end(), frame.across_error.begin(), frame.across_error.end());
    }
  }
  summary.stereo = pool(stereo);
  summary.temporal_left = pool(temporal_left);
  summary.temporal_right = pool(temporal_right);
  const double quads = static_cast<double>(summary.quads_paired.candidates);
  summary.quads_ambiguity_mean = quads > 0 ? static_cast<double>(rivals) / quads : std::numeric_limits<double>::quiet_NaN();
  for (const float error : errors) absolute.push_back(std::abs(error));
  summary.disparity_median = quantile(absolute, 0.5);
  summary.disparity_p90 = quantile(absolute, 0.9);
  summary.disparity_bias = quantile(errors, 0.5);
  summary.across_median = quantile(across, 0.5);
  summary.across_p90 = quantile(across, 0.9);
  return summary;
}

}  // namespace quadedge::evaluation
