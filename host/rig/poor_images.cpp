#include "rig/poor_images.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/numeric.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {
namespace {

/// Median brightness of the right patches over the left ones; 1 without aligned corners.
double brightness_of_right(const CornerSearch& search) {
  std::vector<double> ratios;
  for (const CornerMatch& match : search.found)
    if (match.is_aligned) ratios.push_back(match.brightness);
  return ratios.size() < kMinFitCorners ? 1 : upper_median(ratios);
}

}  // namespace

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
  const double brightness = brightness_of_right(search);
  if (std::max(brightness, 1 / brightness) > kUnevenBrightness)
    return finding(RigFindingKind::uneven_images, brightness);
  return std::nullopt;
}

}  // namespace quadedge::rig
