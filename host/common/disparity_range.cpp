#include "common/disparity_range.hpp"

#include <algorithm>
#include <sstream>

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
  std::ostringstream found;
  found << source << ": found a focal length of " << rig.left.fx << " px and a baseline of " << rig.baseline()
        << " m, so that near objects have disparities of " << rig.disparity_range()
        << " px, expected pixels and metres that give at most 10000 px";
  throw DataError(found.str());
}

}  // namespace quadedge
