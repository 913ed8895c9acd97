/// \file temporal_matching.cpp  Points sorted by cell, filters in both images, agreement; unique global matches.
#include "reference/temporal_matching.hpp"

#include <algorithm>
#include <cmath>

#include "common/matching_constants.hpp"
#include "common/numeric.hpp"
#include "reference/edge_descriptions.hpp"

namespace quadedge::reference {
namespace {

/// Number of groups that chain up by position and direction: single linkage, flooding from every member without a
/// group.
int count_clusters(const std::vector<std::size_t>& members, const StereoEdges& edges) {
  std::vector<bool> reached(members.size(), false);
  int clusters = 0;
  for (std::size_t seed = 0; seed < members.size(); ++seed) {
    if (reached[seed]) continue;
    ++clusters;
    reached[seed] = true;
    std::vector<std::size_t> open = {members[seed]};
    while (!open.empty()) {
      const std::size_t a = open.back();
      open.pop_back();
      for (std::size_t m = 0; m < members.size(); ++m) {
        const std::size_t b = members[m];
        if (reached[m] ||
            std::hypot(edges.left_x[a] - edges.left_x[b], edges.left_y[a] - edges.left_y[b]) >= kClusterGap)
          continue;
        if (angle_between(edges.left_direction[a], edges.left_direction[b]) > kClusterOrientation) continue;
        reached[m] = true;
        open.push_back(b);
      }
    }
  }
  return clusters;
}

/// Rows that kept a candidate.
int alive_rows(const TemporalMatchLists& lists) {
  int rows = 0;
  for (std::size_t row = 0; row + 1 < lists.candidates.first.size(); ++row) {
    const auto begin = lists.scores.state.begin() + lists.candidates.first[row],
               end = lists.scores.state.begin() + lists.candidates.first[row + 1];
    if (std::find(begin, end, kCandidateAlive) != end) ++rows;
  }
  return rows;
}

/// Filters 1 to 6 in one image.
TemporalMatchLists match_side(const EdgePositionsView& predicted, const EdgePositionsView& current,
                              const TemporalMatchSide& side, const TemporalSearch& search,
                              const TemporalConfig& config) {
  PointIndex index;
  make_point_index(current.x, current.y, side.width, side.height, index);
  TemporalMatchLists lists;
  lists.candidates = temporal_candidates(predicted, current, index, search.radius,
                                         static_cast<float>(kTemporalOrientation), search.step);
  lists.scores =
      candidate_filters(lists.candidates, side.base, side.current, temporal_limits(config, search), search.step);
  return lists;
}

constexpr float kSquare = static_cast<float>(kHistogramNorm * kHistogramNorm);  // squared norm of a wide descriptor

float similarity(const WideEdges& a, std::size_t i, const WideEdges& b, std::size_t j) {
  int sum = 0;
  for (std::size_t k = 0; k < kWideBytes; ++k)
    sum += a.descriptors[i * kWideBytes + k] * b.descriptors[j * kWideBytes + k];
  return static_cast<float>(sum);  // whole numbers below 2^24
}

bool apart(const WideEdges& set, std::size_t i, std::size_t j, float distance) {
  const auto step = static_cast<std::size_t>(set.step);
  const float dx = set.edges.left_x[i * step] - set.edges.left_x[j * step],
              dy = set.edges.left_y[i * step] - set.edges.left_y[j * step];
  return dx * dx + dy * dy > distance * distance;
}

}  // namespace

void make_point_index(const std::vector<float>& xs, const std::vector<float>& ys, int width, int height,
                      PointIndex& index) {
  index.columns = static_cast<int>((static_cast<float>(width) + kCellWidth - 1) / kCellWidth);
  index.rows = static_cast<int>((static_cast<float>(height) + kCellHeight - 1) / kCellHeight);
  const auto cell = [&](std::size_t i) {
    return static_cast<std::size_t>(index.row(ys[i]) * index.columns + index.column(xs[i]));
  };
  const auto cells = static_cast<std::size_t>(index.columns * index.rows);
  // Two positions ahead, so that filling moves every start to where the cell's own entry has to be.
  auto& first = index.cell_first;
  first.assign(cells + 2, 0);
  for (std::size_t i = 0; i < xs.size(); ++i) ++first[cell(i) + 2];
  for (std::size_t c = 2; c < first.size(); ++c) first[c] += first[c - 1];
  index.order.resize(xs.size());
  for (std::size_t i = 0; i < xs.size(); ++i)
    index.order[static_cast<std::size_t>(first[cell(i) + 1]++)] = static_cast<std::int32_t>(i);
  first.pop_back();
}

Candidates temporal_candidates(const EdgePositionsView& predicted, const EdgePositionsView& current,
                               const PointIndex& index, float radius, float orientation, int row_step) {
  Candidates candidates;
  candidates.first.assign(1, 0);
  for (std::size_t i = 0; i < predicted.x.size(); i += static_cast<std::size_t>(row_step)) {
    const float x = predicted.x[i], y = predicted.y[i];
    if (std::isfinite(x) && std::isfinite(y) && std::isfinite(predicted.direction[i])) {
      index.visit_square(x, y, radius, [&](std::int32_t number) {
        const auto j = static_cast<std::size_t>(number);
        const float dx = current.x[j] - x, dy = current.y[j] - y;
        if (dx * dx + dy * dy > radius * radius) return;
        if (angle_between(current.direction[j], predicted.direction[i]) > orientation) return;
        candidates.target.push_back(number);
      });
    }
    candidates.first.push_back(static_cast<std::int32_t>(candidates.target.size()));
  }
  return candidates;
}

std::vector<float> temporal_agreement(const Candidates& left_candidates, CandidateScores& left,
                                      const Candidates& right_candidates, const CandidateScores& right) {
  std::vector<float> agreement(left_candidates.target.size(), 0.0f);
  for (std::size_t row = 0; row + 1 < left_candidates.first.size(); ++row) {
    for (auto c = static_cast<std::size_t>(left_candidates.first[row]);
         c < static_cast<std::size_t>(left_candidates.first[row + 1]); ++c) {
      if (left.state[c] != kCandidateAlive) continue;
      bool found = false;
      for (auto d = static_cast<std::size_t>(right_candidates.first[row]);
           d < static_cast<std::size_t>(right_candidates.first[row + 1]) && !found; ++d) {
        if (right.state[d] != kCandidateAlive || right_candidates.target[d] != left_candidates.target[c]) continue;
        found = true;
        agreement[c] = 0.5f * (left.ncc[c] + right.ncc[d]);
      }
      if (!found) left.state[c] = static_cast<std::uint8_t>(order_of(TemporalFilter::agreement));
    }
  }
  return agreement;
}

TemporalMatches temporal_best(const Candidates& candidates, const CandidateScores& scores,
                              const std::vector<float>& agreement, const StereoEdges& current,
                              const TemporalConfig& config, const TemporalSearch& search) {
  const float distance_weight = static_cast<float>(config.distance_weight) / (search.radius * search.radius);
  TemporalMatches matches;
  for (std::size_t row = 0; row + 1 < candidates.first.size(); ++row) {
    const std::size_t i = row * static_cast<std::size_t>(search.step);
    std::vector<std::size_t> alive;  // current edges
    std::size_t winner = 0;
    float highest = 0;
    for (auto c = static_cast<std::size_t>(candidates.first[row]);
         c < static_cast<std::size_t>(candidates.first[row + 1]); ++c) {
      if (scores.state[c] != kCandidateAlive) continue;
      const auto j = static_cast<std::size_t>(candidates.target[c]);
      const float dx = current.left_x[j] - search.left.x[i], dy = current.left_y[j] - search.left.y[i];
      const float weighed = agreement[c] - distance_weight * (dx * dx + dy * dy);
      if (alive.empty() || weighed > highest) {
        winner = c;
        highest = weighed;
      }
      alive.push_back(j);
    }
    if (alive.empty()) continue;
    matches.append(static_cast<std::int32_t>(i), candidates.target[winner], current, agreement[winner],
                   count_clusters(alive, current) - 1);
  }
  return matches;
}

TemporalMatchResult temporal_match(const TemporalSearch& search, const StereoEdges& current,
                                   const TemporalMatchSide& left, const TemporalMatchSide& right,
                                   const TemporalConfig& config) {
  TemporalMatchResult result;
  result.left = match_side(search.left, current.positions(Side::left), left, search, config);
  result.right = match_side(search.right, current.positions(Side::right), right, search, config);
  const int alive_left = alive_rows(result.left), alive_right = alive_rows(result.right);
  const auto agreement =
      temporal_agreement(result.left.candidates, result.left.scores, result.right.candidates, result.right.scores);
  result.matches = temporal_best(result.left.candidates, result.left.scores, agreement, current, config, search);
  result.matches.alive_left = alive_left;
  result.matches.alive_right = alive_right;
  return result;
}

TemporalMatches find_global_matches(const WideEdges& earlier, const WideEdges& current) {
  const std::size_t rows = earlier.descriptors.size() / kWideBytes, columns = current.descriptors.size() / kWideBytes;
  const float neighbourhood = static_cast<float>(kWideNeighbourhood), ratio = static_cast<float>(kWideRatio);
  TemporalMatches matches;
  for (std::size_t row = 0; row < rows; ++row) {
    std::size_t winner = columns;
    float highest = 0;
    for (std::size_t column = 0; column < columns; ++column) {
      const float value = similarity(earlier, row, current, column);
      if (value > highest) {
        winner = column;
        highest = value;
      }
    }
    if (winner == columns) continue;
    const float limit = kSquare - (kSquare - highest) / (ratio * ratio);
    bool unique = true;
    for (std::size_t other = 0; other < rows && unique; ++other) {
      unique = !(apart(earlier, other, row, neighbourhood) && similarity(earlier, other, current, winner) >= highest);
    }
    for (std::size_t column = 0; column < columns && unique; ++column) {
      unique = !(apart(current, column, winner, neighbourhood) && similarity(earlier, row, current, column) > limit);
    }
    if (!unique) continue;
    matches.append(static_cast<std::int32_t>(row) * earlier.step, static_cast<std::int32_t>(winner) * current.step,
                   current.edges, highest / kSquare, 0);
  }
  return matches;
}

}  // namespace quadedge::reference
