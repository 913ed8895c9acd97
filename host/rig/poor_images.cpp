/// \file poor_images.cpp  Differences on both sides of block borders, counts of saturated corners, ratio of brightness.
#include "rig/poor_images.hpp"

#include <algorithm>
#include <cmath>

#include "rig/rig_constants.hpp"

namespace quadedge::rig {
double blockiness(const ImageView& image) {
  double between = 0, inside = 0;
  long borders = 0, others = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 1; x < image.width; ++x) {
      const double step = std::abs(static_cast<double>(image.at(x, y) - image.at(x - 1, y)));
      const bool is_border = x % kBlock == 0;
      (is_border ? between : inside) += step;
      ++(is_border ? borders : others);
    }
  }
  if (borders == 0 || !(inside > 0)) return 1;
  return between / static_cast<double>(borders) / (inside / static_cast<double>(others));
}

bool is_uneven(const CornerSearch& search) {
  return std::max(search.brightness, 1 / std::max(search.brightness, 1e-3)) > kUnevenBrightness;
}

bool hides_corners(const CornerSearch& search) {
  return is_uneven(search) && search.more_saturated > kUnevenSaturation;
}

std::optional<RigFinding> find_poor_images(const CornerSearch& search, const StereoFrame& frame) {
  const auto finding = [](RigFindingKind kind, double figure) {
    RigFinding found{kind};
    found.poor = figure;
    return found;
  };
  const double saturated = static_cast<double>(search.saturated) / std::max(1, search.searched + search.saturated);
  if (saturated > kSaturatedRatio) return finding(RigFindingKind::saturated_images, saturated);
  const double blocks = std::min(blockiness(frame.left), blockiness(frame.right));
  if (blocks > kBlockiness) return finding(RigFindingKind::compressed_images, blocks);
  return is_uneven(search) ? std::optional(finding(RigFindingKind::uneven_images, search.brightness)) : std::nullopt;
}

}  // namespace quadedge::rig
