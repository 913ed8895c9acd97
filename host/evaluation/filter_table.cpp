#include "evaluation/filter_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/numeric.hpp"
#include "evaluation/pools.hpp"
#include "quadedge/error.hpp"

namespace quadedge::evaluation {
void FilterCounts::add_edge(std::int64_t candidates_of_edge, std::int64_t veridical_of_edge) {
  ++pool;
  found += veridical_of_edge > 0 ? 1 : 0;
  alive += candidates_of_edge > 0 ? 1 : 0;
  candidates += candidates_of_edge;
  veridical += veridical_of_edge;
  most_candidates = std::max(most_candidates, candidates_of_edge);
}

void FilterCounts::add(const FilterCounts& other) {
  pool += other.pool;
  found += other.found;
  alive += other.alive;
  candidates += other.candidates;
  veridical += other.veridical;
  most_candidates = std::max(most_candidates, other.most_candidates);
}

double FilterCounts::recall() const { return ratio(found, pool); }
double FilterCounts::precision() const { return ratio(veridical, candidates); }
double FilterCounts::ambiguity_mean() const { return ratio(candidates, alive) - 1; }
double FilterCounts::ambiguity_max() const {
  return most_candidates > 0 ? static_cast<double>(most_candidates - 1) : std::numeric_limits<double>::quiet_NaN();
}

void add(FilterTable& sum, const FilterTable& other) {
  if (sum.empty()) {
    sum = other;
    return;
  }
  if (other.empty()) return;
  if (sum.size() != other.size()) throw UsageError("tables of different filters cannot be pooled");
  for (std::size_t row = 0; row < sum.size(); ++row) {
    if (sum[row].order != other[row].order) throw UsageError("tables of different filters cannot be pooled");
    sum[row].paired.add(other[row].paired);
    sum[row].all.add(other[row].all);
  }
}

bool is_veridical(const TruePositions& truth, std::size_t i, double x, double y, const MatchingTolerance& tolerance) {
  if (truth.state[i] != Visibility::visible) return false;
  return std::hypot(x - truth.x[i], y - truth.y[i]) <= tolerance.position;
}

FilterRow judge(int order, const std::string& filter, const CandidateLists& lists, const std::vector<float>& target_x,
                const std::vector<float>& target_y, const TruePositions& truth, const Pools& pools,
                const MatchingTolerance& tolerance) {
  const bool refined = lists.x.size() == lists.target.size();
  FilterRow row{order, filter, {}, {}};
  for (std::size_t i = 0; i + 1 < lists.first.size(); ++i) {
    if (pools.all[i] == 0) continue;
    std::int64_t veridical = 0;
    for (auto k = static_cast<std::size_t>(lists.first[i]); k < static_cast<std::size_t>(lists.first[i + 1]); ++k) {
      const auto target = static_cast<std::size_t>(lists.target[k]);
      const float x = refined ? lists.x[k] : target_x[target], y = refined ? lists.y[k] : target_y[target];
      veridical += is_veridical(truth, i, x, y, tolerance) ? 1 : 0;
    }
    const std::int64_t candidates = lists.first[i + 1] - lists.first[i];
    row.all.add_edge(candidates, veridical);
    if (pools.paired[i] != 0) row.paired.add_edge(candidates, veridical);
  }
  return row;
}

FilterRow judge_baseline(const std::string& filter, const std::vector<float>& target_x,
                         const std::vector<float>& target_y, int image_height, const TruePositions& truth,
                         const Pools& pools, const MatchingTolerance& tolerance) {
  const NearbyTargets nearby(target_x, target_y, image_height);
  FilterRow row{0, filter, {}, {}};
  for (std::size_t i = 0; i < pools.all.size(); ++i) {
    if (pools.all[i] == 0) continue;
    std::int64_t veridical = 0;
    if (truth.state[i] == Visibility::visible) {
      nearby.visit(truth.x[i], truth.y[i], tolerance.position, [&](std::size_t) { ++veridical; });
    }
    const auto candidates = static_cast<std::int64_t>(target_x.size());
    row.all.add_edge(candidates, veridical);
    if (pools.paired[i] != 0) row.paired.add_edge(candidates, veridical);
  }
  return row;
}

}  // namespace quadedge::evaluation
