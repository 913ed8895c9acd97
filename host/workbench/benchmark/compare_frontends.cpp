/// \file compare_frontends.cpp  Compares array by array in the order of the stages, up to the first value that differs.
#include "benchmark/compare_frontends.hpp"

#include <algorithm>
#include <vector>

#include "common/printed.hpp"
#include "edges/prediction.hpp"

namespace quadedge::frontend {
namespace {

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
    if (i == both) {
      found_ = printed("%s, %s: %zu instead of %zu values of %s", stage_, row_, a.size(), b.size(), value);
    } else {
      found_ = printed("%s, %s %zu: %s is %.9g instead of %.9g", stage_, row_, i, value, static_cast<double>(a[i]),
                       static_cast<double>(b[i]));
    }
    return *this;
  }

 private:
  const char *stage_, *row_;
  std::string& found_;
};

void compare(const char* row, const EdgeSet& a, const EdgeSet& b, std::string& found) {
  Difference("edge_detection", row, found)("x", a.x, b.x)("y", a.y, b.y)("direction", a.direction, b.direction)(
      "strength", a.strength, b.strength)("scale-space shift", a.scale_shift, b.scale_shift);
  Difference("edge_detection", "row start", found)("number", a.row_first, b.row_first);
}
void compare(const char* row, const StereoEdges& a, const StereoEdges& b, std::string& found) {
  Difference("stereo_mutual", row, found)("left edge", a.left_index, b.left_index)(
      "right edge", a.right_index, b.right_index)("left x", a.left_x, b.left_x)("left y", a.left_y, b.left_y)(
      "left direction", a.left_direction, b.left_direction)("right x", a.right_x, b.right_x)(
      "right y", a.right_y, b.right_y)("right direction", a.right_direction, b.right_direction)("NCC", a.ncc, b.ncc)(
      "scale-space shift", a.left_scale_shift, b.left_scale_shift);
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
  output.quads = frontend.match(*output.first, search_without_motion(output.previous, config.temporal, false));
  if (!config.is_paper()) {  // which has this search only
    output.coarse = frontend.match(*output.first, search_without_motion(output.previous, config.temporal, true));
    output.global_matches = frontend.match_globally(*output.first, config.temporal.global_edges);
  }
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
  compare("global_matching", "quad of the global search", a.global_matches, b.global_matches, found);
  return found;
}

}  // namespace quadedge::frontend
