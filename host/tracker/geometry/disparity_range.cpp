/// \file disparity_range.cpp  A range by the nearest depth; levels of the coarse search if epipolar lines are rows.
#include "geometry/disparity_range.hpp"

#include <algorithm>
#include <cmath>

#include "common/numeric.hpp"
#include "common/printed.hpp"
#include "geometry/epipolar_geometry.hpp"
#include "quadedge/error.hpp"

namespace quadedge {

bool has_disparity_range(const StereoConfig& config) { return config.max_disparity != 0 || config.min_depth != 0; }

Config with_disparity_range(Config config, const StereoRig& rig) {
  if (has_disparity_range(config.stereo)) return config;
  check_disparity_range(rig, "stereo rig");
  config.stereo.max_disparity = rig.disparity_range();
  return config;
}

double disparity_limit(const StereoRig& rig) {
  constexpr double kLimit = 0.5;  // of the width: what is nearer is hardly in view of both cameras
  return std::max(kLimit * rig.left.width, rig.max_disparity);
}

void check_disparity_range(const StereoRig& rig, const std::string& source) {
  constexpr double kLargest = 10'000;  // px; constants.inc allows no more for stereo.max_disparity
  if (rig.disparity_range() <= kLargest) return;
  throw DataError(source + printed(": found a focal length of %g px and a baseline of %g m, so that near objects have "
                                   "disparities of %g px, expected pixels and metres that give at most 10000 px",
                                   rig.left.fx, rig.baseline(), rig.disparity_range()));
}

namespace {

constexpr double kMostCells = 1 << 27;  // of the search, three bytes each
constexpr float kStraight = 0.5F;       // px by which the epipolar lines of a rectified rig may leave their row

}  // namespace

std::optional<CoarseDisparityArguments> coarse_search(const StereoRig& rig, const EpipolarGeometry& geometry) {
  const auto width = static_cast<float>(rig.left.width - 1), height = static_cast<float>(rig.left.height - 1);
  const EpipolarLine corner = epipolar_line(geometry, 0, 0);
  const float ahead = corner.x;
  for (const float x : {0.0F, width}) {
    for (const float y : {0.0F, height}) {
      const EpipolarLine line = epipolar_line(geometry, x, y);
      const bool straight = line.valid && line.ex < 0 && std::abs(line.y - y) < kStraight &&
                            std::abs(line.x - x - ahead) < kStraight && std::abs(line.ey) * width < kStraight;
      if (!straight) return std::nullopt;
    }
  }
  CoarseDisparityArguments search{};
  search.width = rig.left.width / 2;
  search.height = std::min(rig.left.height, rig.right.height) / 2;
  search.right_width = rig.right.width / 2;
  search.shift = static_cast<int>(std::floor(0.5F * ahead)) + 1;
  search.first = ahead - 2.0F * static_cast<float>(search.shift);
  const float last = corner.s_max + geometry.tolerance;
  search.levels = std::min<int>(kCoarseMostLevels,
                                round_up(static_cast<int>(std::ceil(0.5F * (last - search.first))) + 1, kCoarseLanes));
  search.step_penalty = kCoarseStepPenalty;
  search.jump_penalty = kCoarseJumpPenalty;
  search.right_front = std::max(0, search.width - search.right_width + search.shift);
  search.right_first = search.right_front + search.right_width - 1 - search.shift;
  search.right_stride = std::max(search.right_front + search.right_width, search.right_first + search.levels);
  const double cells = static_cast<double>(search.width) * search.height * search.levels;
  if (search.width < 1 || search.height < 1 || search.right_width < 1 || cells > kMostCells) return std::nullopt;
  return search;
}

}  // namespace quadedge
