#include "frontend/compare_frontends.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <utility>

#include "frontend/prediction.hpp"

namespace quadedge::frontend {
namespace {

/// A position in the left image in hundredths of a pixel. Rows are matched by position, because one additional edge in
/// a list shifts all indices.
using Key = std::pair<long, long>;
Key key(float x, float y) { return {std::lround(100 * x), std::lround(100 * y)}; }

/// Rows of `a` that `b` contains as well, by left position and right column.
struct Shared {
  double fraction = 1;
  std::optional<std::size_t> first_missing;
};
template <class Rows>
Shared shared(const Rows& a, const Rows& b) {
  Shared result;
  if (a.size() == 0) return result;
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
    if (!hit && !result.first_missing) result.first_missing = i;
  }
  result.fraction = static_cast<double>(found) / static_cast<double>(a.size());
  return result;
}

/// The smaller fraction of both directions. Sets `first`, if empty, to the first row that one side lacks.
template <class Rows>
double both_ways(const char* what, const Rows& a, const Rows& b, std::string& first) {
  const Shared forth = shared(a, b), back = shared(b, a);
  const auto tell = [&](const Rows& rows, const std::optional<std::size_t>& row, const char* whose) {
    if (!row || !first.empty()) return;
    char text[160];
    std::snprintf(text, sizeof text, "%s %zu at (%.2f, %.2f), right column %.2f, is %s", what, *row, rows.left_x[*row],
                  rows.left_y[*row], rows.right_x[*row], whose);
    first = text;
  };
  tell(a, forth.first_missing, "not in the reference");
  tell(b, back.first_missing, "in the reference alone");
  return std::min(forth.fraction, back.fraction);
}

/// The first differing value of parallel arrays.
class Difference {
 public:
  /// \param stage that writes the arrays \param row name of a row in messages
  Difference(const char* stage, const char* row, std::string& found) : stage_(stage), row_(row), found_(found) {}

  template <class T>
  Difference& operator()(const char* value, const std::vector<T>& a, const std::vector<T>& b) {
    if (!found_.empty() || a == b) return *this;
    const std::size_t both = std::min(a.size(), b.size());
    std::size_t i = 0;
    while (i < both && a[i] == b[i]) ++i;
    char text[160];
    if (i == both) {
      std::snprintf(text, sizeof text, "%s, %s: %zu instead of %zu values of %s", stage_, row_, a.size(), b.size(),
                    value);
    } else {
      std::snprintf(text, sizeof text, "%s, %s %zu: %s is %.9g instead of %.9g", stage_, row_, i, value,
                    static_cast<double>(a[i]), static_cast<double>(b[i]));
    }
    found_ = text;
    return *this;
  }

 private:
  const char *stage_, *row_;
  std::string& found_;
};

void compare(const char* row, const EdgeSet& a, const EdgeSet& b, std::string& found) {
  Difference("edge_detection", row, found)("x", a.x, b.x)("y", a.y, b.y)("direction", a.direction, b.direction)(
      "strength", a.strength, b.strength)("scale drift", a.scale_drift, b.scale_drift);
  Difference("edge_detection", "row start", found)("number", a.row_first, b.row_first);
}
void compare(const char* row, const StereoEdges& a, const StereoEdges& b, std::string& found) {
  Difference("stereo_mutual", row, found)("left edge", a.left_index, b.left_index)(
      "right edge", a.right_index, b.right_index)("left x", a.left_x, b.left_x)("left y", a.left_y, b.left_y)(
      "left direction", a.left_direction, b.left_direction)("right x", a.right_x, b.right_x)(
      "right y", a.right_y, b.right_y)("right direction", a.right_direction, b.right_direction)("NCC", a.ncc, b.ncc)(
      "scale drift", a.left_scale_drift, b.left_scale_drift);
}
void compare(const char* stage, const char* row, const TemporalMatches& a, const TemporalMatches& b,
             std::string& found) {
  Difference(stage, row, found)("previous edge", a.previous, b.previous)("current edge", a.current, b.current)(
      "left x", a.left_x, b.left_x)("left y", a.left_y, b.left_y)("right x", a.right_x, b.right_x)(
      "right y", a.right_y, b.right_y)("NCC", a.ncc, b.ncc)("competing clusters", a.competing_clusters,
                                                            b.competing_clusters);
}

}  // namespace

FrontendOutput run_frontend(Frontend& frontend, const StereoFrame& first, const StereoFrame& second,
                            const Config& config) {
  FrontendOutput output;
  output.first = frontend.process(first);
  const auto now = frontend.process(second);
  output.previous = output.first->edges;
  output.coarse = frontend.match(*output.first, search_without_motion(output.previous, config.temporal, true));
  output.quads = frontend.match(*output.first, search_without_motion(output.previous, config.temporal, false));
  output.global_matches = frontend.match_globally(*output.first, config.temporal.wide_edges);
  output.left_edges = frontend.edges(Side::left);
  output.right_edges = frontend.edges(Side::right);
  output.current = now->edges;
  return output;
}

std::string first_difference(const FrontendOutput& a, const FrontendOutput& b) {
  std::string found;
  compare("left edge", a.left_edges, b.left_edges, found);
  compare("right edge", a.right_edges, b.right_edges, found);
  compare("stereo edge of the first frame", a.previous, b.previous, found);
  compare("stereo edge of the second frame", a.current, b.current, found);
  compare("temporal_match", "quad of the coarse search", a.coarse, b.coarse, found);
  compare("temporal_match", "quad", a.quads, b.quads, found);
  compare("wide_matching", "quad of the global search", a.global_matches, b.global_matches, found);
  return found;
}

Agreement agreement(const FrontendOutput& a, const FrontendOutput& b) {
  Agreement result;
  const double previous = both_ways("stereo edge of the first frame", a.previous, b.previous, result.first),
               current = both_ways("stereo edge of the second frame", a.current, b.current, result.first),
               coarse = both_ways("quad of the coarse search", a.coarse, b.coarse, result.first),
               quads = both_ways("quad", a.quads, b.quads, result.first);
  result.stereo = std::min(previous, current);
  result.quads = std::min(coarse, quads);
  return result;
}

}  // namespace quadedge::frontend
