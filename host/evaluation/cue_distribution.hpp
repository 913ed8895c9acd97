#pragma once
/// \file cue_distribution.hpp  Distributions of the filters' cues over veridical and other pairs (the paper's Figures
/// 3, 5 and 6).

#include <cstdint>
#include <string>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge::evaluation {

/// Counts of values in bins of equal width.
struct Histogram {
  double low = 0, high = 1;
  std::vector<std::int64_t> bins;
  std::int64_t below = 0, above = 0;  ///< values outside low .. high

  Histogram() = default;
  Histogram(double from, double to, int count) : low(from), high(to), bins(static_cast<std::size_t>(count), 0) {}
  /// Adds a value; NaN is ignored.
  void add(double value);
  /// Adds counts. \throws UsageError if the bins differ
  void add(const Histogram& other);
  std::int64_t total() const;  ///< all values, including those outside the range
  double width() const { return (high - low) / static_cast<double>(bins.size()); }
};

/// Cascade to which a filter belongs.
enum class CueTable { stereo, temporal_left, temporal_right, constraints };
inline constexpr const char* kCueTableNames[] = {"stereo", "temporal_left", "temporal_right", "constraints"};

/// Values of one cue over the pairs that reach the filter using it.
struct CueDistribution {
  CueTable table;
  int order;                       ///< number of the filter (Tables 1 and 2) or constraint (Table 3)
  std::string cue, unit;           ///< the unit may be empty
  bool keeps_small;                ///< the filter keeps values below its threshold
  bool sampled;                    ///< the other pairs are a random sample, because there are too many
  std::vector<double> thresholds;  ///< from the configuration; several for pooled data, none if it depends on the edge
  Histogram veridical, other;      ///< edges of the paired pool
  Histogram veridical_all, other_all;  ///< edges of the pool `all`; empty for constraints, which apply to quads
};

/// All cues, without values. `config` is the effective configuration, including the disparity limit of the dataset.
std::vector<CueDistribution> make_cues(const StereoRig& rig, const Config& config);

/// Adds histograms and merges thresholds. An empty `sum` becomes `other`.
void add(std::vector<CueDistribution>& sum, const std::vector<CueDistribution>& other);

/// The cue used by filter `order` of a cascade; null for a filter without one.
CueDistribution* find_cue(std::vector<CueDistribution>& cues, CueTable table, int order);

}  // namespace quadedge::evaluation
