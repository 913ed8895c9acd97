#pragma once
/// \file paper_lists.hpp  Made-up lists of candidates for the tests of the paper's refinement and clusters.

#include "device/paper_matching.hpp"
#include "edge_images.hpp"
#include "matching.hpp"
#include "paper/cascades.hpp"

namespace matching {

/// A smooth texture with two waves of noise, moved by (dx, dy) px.
inline Image paper_image(int width, int height, double dx, double dy, int max_value = kMaxValue8) {
  Random noise(static_cast<std::uint64_t>(7 + 10 * (dx + dy)));
  return filled_image(width, height, max_value, [&](int x, int y) {
    const double grey = std::clamp(smooth_grey(x - dx, y - dy) + noise(-4, 4), 0.0, 255.0);
    return static_cast<int>(std::lround(grey * max_value / kMaxValue8));
  });
}

/// Edges of one image, candidates in the other, and which of them are alive.
struct PaperLists {
  EdgeSet fixed, moving;
  reference::Candidates candidates;
  reference::CandidateScores scores;
};

/// Rows of 0 to `most` candidates around place(x, y), which shows the row's edge in the other image; one of five is
/// rejected.
inline PaperLists paper_lists(int width, int height, int rows, int most, std::uint64_t seed,
                              const std::function<std::array<double, 2>(float, float)>& place) {
  PaperLists lists;
  Random random(seed);
  lists.candidates.first.push_back(0);
  const auto add = [](EdgeSet& edges, double x, double y, double direction) {
    edges.x.push_back(static_cast<float>(x));
    edges.y.push_back(static_cast<float>(y));
    edges.direction.push_back(static_cast<float>(std::remainder(direction, 2 * kPi)));
  };
  for (int i = 0; i < rows; ++i) {
    const double direction = random(-kPi, kPi);
    add(lists.fixed, random(0, width - 1), random(0, height - 1), direction);
    const auto at = place(lists.fixed.x.back(), lists.fixed.y.back());
    const int count = static_cast<int>(random(0, most + 0.999));
    for (int k = 0; k < count; ++k) {
      lists.candidates.target.push_back(static_cast<std::int32_t>(lists.moving.x.size()));
      lists.scores.state.push_back(random(0, 1) < 0.2 ? 5 : kCandidateAlive);
      add(lists.moving, at[0] + random(-1.2, 1.2), at[1] + random(-0.7, 0.7),
          direction + random(-0.3, 0.3) + (random(0, 1) < 0.1 ? kPi : 0));
    }
    lists.candidates.first.push_back(static_cast<std::int32_t>(lists.candidates.target.size()));
  }
  for (auto* edges : {&lists.fixed, &lists.moving}) edges->strength = edges->scale_shift = edges->x;
  lists.scores.ncc = lists.scores.sift = std::vector<float>(lists.candidates.target.size());
  return lists;
}

/// An image with its edges on a device.
struct PaperOnDevice {
  stages::PaperPatches stage;
  stages::DeviceEdges edges;
  opencl::Buffer<cl_float> patches;

  PaperOnDevice(opencl::Context& context, const Image& image, const EdgeSet& set, double offset)
      : stage(context, image.width, image.height, {}, image.max_value), edges(upload(context, set)) {
    opencl::Buffer<cl_uchar> pixels;
    pixels.write(context, image.pixels);
    stage.prepare(pixels);
    stage.cut(edges.positions(), offset, patches);
  }
  stages::PaperEdges view() const { return {stage.picture(), edges.positions(), patches}; }
};

}  // namespace matching
