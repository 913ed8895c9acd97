#pragma once
/// \file cues.hpp  Distributions of the filters' cues over veridical and other pairs (the paper's Figures 3, 5 and 6),
/// and their collection from a tap.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "evaluation/filter_table.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/tap.hpp"

namespace quadedge::evaluation {

/// Uniform in 0 .. size - 1.
inline std::size_t draw(std::mt19937_64& random, std::size_t size) {
  return static_cast<std::size_t>(static_cast<double>(random() >> 11) * 0x1p-53 * static_cast<double>(size));
}

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

/// Data that determine whether a candidate is veridical, and to which pools its row belongs.
struct CandidateTruth {
  const TruePositions& truth;
  const Pools& pools;
  const MatchingTolerance& tolerance;
  const std::vector<float>& target_x;  ///< positions of the targets [px]
  const std::vector<float>& target_y;
};

/// The value of a cue for row i and a target. NaN: no value.
using PairValue = std::function<double(std::size_t row, std::size_t target)>;

/// Collects a geometric cue for all candidates in the lists.
void collect_geometry(const CandidateLists& lists, const CandidateTruth& judge, const PairValue& value,
                      CueDistribution& cue);

/// Collects the scores stored in the lists.
void collect_scores(const CandidateLists& lists, const CandidateTruth& judge, CueDistribution& cue);

/// Collects the scores stored in the lists, relative to the best of each list: value / highest, or lowest / value.
void collect_ratios(const CandidateLists& lists, const CandidateTruth& judge, bool highest_is_best,
                    CueDistribution& cue);

/// Collects a cue before the first filter, when every row is paired with every target: all veridical pairs, and
/// kDrawnOthers of the others per row.
/// \param image_height height of the targets' image [px]
void collect_unfiltered(const CandidateTruth& judge, int image_height, std::uint64_t seed, const PairValue& value,
                        CueDistribution& cue);
inline constexpr int kDrawnOthers = 40;

}  // namespace quadedge::evaluation
