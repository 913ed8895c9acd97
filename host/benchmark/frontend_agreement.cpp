#include "benchmark/frontend_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace quadedge::bench {
namespace {

/// A position in the left image in hundredths of a pixel. Rows are compared by it: an edge more in one list shifts all
/// numbers.
using Key = std::pair<long, long>;
Key key(float x, float y) { return {std::lround(100 * x), std::lround(100 * y)}; }

/// Fraction of the rows of `a` that `b` holds too: left positions and right column.
template <class Rows>
double shared(const Rows& a, const Rows& b) {
  if (a.size() == 0) return 1;
  std::multimap<Key, float> known;
  for (std::size_t i = 0; i < b.size(); ++i) known.emplace(key(b.left_x[i], b.left_y[i]), b.right_x[i]);
  std::size_t found = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Key middle = key(a.left_x[i], a.left_y[i]);
    bool hit = false;
    for (long dx = -2; dx <= 2 && !hit; ++dx) {
      for (long dy = -2; dy <= 2 && !hit; ++dy) {
        const auto [begin, end] = known.equal_range({middle.first + dx, middle.second + dy});
        hit = std::any_of(begin, end, [&](const auto& row) { return std::abs(a.right_x[i] - row.second) < 0.02F; });
      }
    }
    found += hit ? 1 : 0;
  }
  return static_cast<double>(found) / static_cast<double>(a.size());
}

template <class Rows>
double both_ways(const Rows& a, const Rows& b) {
  return std::min(shared(a, b), shared(b, a));
}

bool same(const EdgeSet& a, const EdgeSet& b) {
  return a.x == b.x && a.y == b.y && a.direction == b.direction && a.strength == b.strength &&
         a.scale_drift == b.scale_drift && a.row_first == b.row_first;
}
bool same(const StereoEdges& a, const StereoEdges& b) {
  return a.left_index == b.left_index && a.right_index == b.right_index && a.left_x == b.left_x &&
         a.left_y == b.left_y && a.left_direction == b.left_direction && a.right_x == b.right_x &&
         a.right_y == b.right_y && a.right_direction == b.right_direction && a.ncc == b.ncc;
}
bool same(const TemporalMatches& a, const TemporalMatches& b) {
  return a.previous == b.previous && a.current == b.current && a.left_x == b.left_x && a.left_y == b.left_y &&
         a.right_x == b.right_x && a.right_y == b.right_y && a.ncc == b.ncc && a.rivals == b.rivals;
}

}  // namespace

TemporalSearch search_without_motion(const StereoEdges& previous, const TemporalConfig& config, bool coarse) {
  TemporalSearch search;
  search.left = {previous.left_x, previous.left_y, previous.left_direction};
  search.right = {previous.right_x, previous.right_y, previous.right_direction};
  search.radius = static_cast<float>(coarse ? config.coarse_radius : config.radius);
  search.coarse = coarse;
  return search;
}

FrontendOutput run_frontend(frontend::Frontend& frontend, const FramePrefetcher::Frame& first,
                            const FramePrefetcher::Frame& second, const Config& config) {
  FrontendOutput output;
  output.first = frontend.process(first.view());
  const auto now = frontend.process(second.view());
  output.previous = output.first->edges;
  output.coarse = frontend.match(*output.first, search_without_motion(output.previous, config.temporal, true));
  output.quads = frontend.match(*output.first, search_without_motion(output.previous, config.temporal, false));
  output.anywhere = frontend.match_anywhere(*output.first);
  output.left_edges = frontend.edges(Side::left);
  output.right_edges = frontend.edges(Side::right);
  output.current = now->edges;
  return output;
}

bool same_bytes(const FrontendOutput& a, const FrontendOutput& b) {
  return same(a.left_edges, b.left_edges) && same(a.right_edges, b.right_edges) && same(a.previous, b.previous) &&
         same(a.current, b.current) && same(a.coarse, b.coarse) && same(a.quads, b.quads) &&
         same(a.anywhere, b.anywhere);
}

Agreement agreement(const FrontendOutput& a, const FrontendOutput& b) {
  return {std::min(both_ways(a.previous, b.previous), both_ways(a.current, b.current)),
          std::min(both_ways(a.coarse, b.coarse), both_ways(a.quads, b.quads))};
}

}  // namespace quadedge::bench
