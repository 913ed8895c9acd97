#include "reference/edge_thinning.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/angles.hpp"

namespace quadedge::reference {
namespace {

// Single precision on purpose: the device decides alike.
constexpr float kSameCurve = 0.25F * static_cast<float>(kPi);

bool same_direction(float a, float b) { return angle_between(a, b) <= kSameCurve; }

}  // namespace

std::vector<std::uint8_t> kept_by_thinning(const EdgeSet& edges) {
  const auto pixel = [](float coordinate) { return static_cast<int>(std::floor(coordinate + 0.5F)); };
  std::vector<std::size_t> by_pixel(edges.size());
  std::iota(by_pixel.begin(), by_pixel.end(), std::size_t{0});
  std::stable_sort(by_pixel.begin(), by_pixel.end(), [&](std::size_t a, std::size_t b) {
    const int row_a = pixel(edges.y[a]), row_b = pixel(edges.y[b]);
    return row_a != row_b ? row_a < row_b : pixel(edges.x[a]) < pixel(edges.x[b]);
  });
  const auto same_pixel = [&](std::size_t a, std::size_t b) {
    return pixel(edges.y[a]) == pixel(edges.y[b]) && pixel(edges.x[a]) == pixel(edges.x[b]);
  };
  std::vector<std::uint8_t> kept(edges.size(), 1);
  for (std::size_t begin = 0, end = 0; begin < by_pixel.size(); begin = end) {
    while (end < by_pixel.size() && same_pixel(by_pixel[begin], by_pixel[end])) ++end;
    for (std::size_t a = begin; a < end; ++a) {
      for (std::size_t b = begin; b < end; ++b) {
        const std::size_t i = by_pixel[a], j = by_pixel[b];
        const bool stronger =
            edges.strength[j] > edges.strength[i] || (edges.strength[j] == edges.strength[i] && j < i);
        if (stronger && same_direction(edges.direction[i], edges.direction[j])) kept[i] = 0;
      }
    }
  }
  return kept;
}

}  // namespace quadedge::reference
