#pragma once
/// \file frontends.hpp  Small rendered scenes and runs of the whole frontend on them.

#include "benchmark/compare_frontends.hpp"
#include "matching.hpp"

namespace matching {

/// A few rendered frames of a small scene, with the search limits that fit it.
struct RenderedScene {
  StereoRig rig;
  Config config;
  std::vector<Image> left, right;
  std::vector<Eigen::Isometry3d> world_from_left;

  RenderedScene(const std::string& name, int width, int height, int frames, int step = 1, int bits = 8,
                double contrast = 1) {
    auto options = rendering(width, height, 0.575 * width, 1 + (frames - 1) * step, 3);
    options.bits = bits;
    options.contrast = contrast;
    options.scene = name;
    options.baseline = 0.15;
    const SyntheticSequence sequence(options);
    rig = sequence.rig();
    config.stereo.max_disparity = sequence.rig().max_disparity;
    for (int i = 0; i < options.frames; i += step) {
      left.push_back(sequence.render(i, Side::left).image);
      right.push_back(sequence.render(i, Side::right).image);
      world_from_left.push_back(sequence.world_from_left(i));
    }
  }
  StereoFrame frame(std::size_t i) const {
    return {static_cast<std::int64_t>(i) * 50000000, left[i].view(), right[i].view()};
  }
};

using frontend::FrontendOutput;

/// A search within `radius` px of the edges' previous positions in both images.
inline TemporalSearch search_around(const StereoEdges& previous, float radius, int step = 1) {
  return {{previous.left_x, previous.left_y, previous.left_direction},
          {previous.right_x, previous.right_y, previous.right_direction},
          radius,
          step};
}

/// What a front end finds in the first two frames, without global search.
inline FrontendOutput run_frontend(const RenderedScene& scene, Device& device, const Variants& variants = {},
                                   Tap* tap = nullptr, float radius = 12, int step = 1) {
  Config config = scene.config;
  config.variants = variants;
  const auto frontend = frontend::make_frontend(scene.rig, device, config);
  frontend->set_tap(tap);
  const auto before = frontend->process(scene.frame(0)), now = frontend->process(scene.frame(1));
  FrontendOutput result;
  result.quads = frontend->match(*before, search_around(before->edges, radius, step));
  result.left_edges = frontend->edges(Side::left);
  result.right_edges = frontend->edges(Side::right);
  result.previous = before->edges;
  result.current = now->edges;
  return result;
}
inline FrontendOutput run_frontend(const RenderedScene& scene, const std::string& device_name,
                                   const Variants& variants = {}, Tap* tap = nullptr, float radius = 12, int step = 1) {
  Device device(device_name, kept_programs());
  return run_frontend(scene, device, variants, tap, radius, step);
}

/// The fraction of rows of `a` that `b` contains, by left position and right column within 0.02 px.
template <class Rows>
double contained(const Rows& a, const Rows& b) {
  std::multimap<long, std::size_t> columns;  // of b, in hundredths of a pixel
  for (std::size_t i = 0; i < b.size(); ++i) columns.emplace(std::lround(100 * b.left_x[i]), i);
  std::size_t found = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const long column = std::lround(100 * a.left_x[i]);
    found += std::any_of(columns.lower_bound(column - 2), columns.upper_bound(column + 2), [&](const auto& entry) {
      const std::size_t k = entry.second;
      return std::abs(a.left_y[i] - b.left_y[k]) < 0.025F && std::abs(a.right_x[i] - b.right_x[k]) < 0.02F;
    });
  }
  return a.size() == 0 ? 1 : static_cast<double>(found) / static_cast<double>(a.size());
}
/// The smaller fraction of both directions. Devices round differently, so candidates near a threshold may differ.
template <class Rows>
double agreement(const Rows& a, const Rows& b) {
  return std::min(contained(a, b), contained(b, a));
}

inline bool same_bytes(const StereoEdges& a, const StereoEdges& b) {
  return a.left_index == b.left_index && a.right_index == b.right_index && a.left_x == b.left_x &&
         a.left_scale_shift == b.left_scale_shift && a.left_y == b.left_y && a.left_direction == b.left_direction &&
         a.right_x == b.right_x && a.right_y == b.right_y && a.right_direction == b.right_direction && a.ncc == b.ncc;
}
inline bool same_bytes(const TemporalMatches& a, const TemporalMatches& b) {
  return a.previous == b.previous && a.current == b.current && a.left_x == b.left_x && a.left_y == b.left_y &&
         a.right_x == b.right_x && a.right_y == b.right_y && a.ncc == b.ncc &&
         a.competing_clusters == b.competing_clusters;
}
inline bool same_bytes(const EdgeSet& a, const EdgeSet& b) {
  return a.x == b.x && a.y == b.y && a.direction == b.direction && a.strength == b.strength &&
         a.scale_shift == b.scale_shift && a.row_first == b.row_first;
}
inline bool same_bytes(const FrontendOutput& a, const FrontendOutput& b) {
  return frontend::first_difference(a, b).empty();
}

}  // namespace matching
