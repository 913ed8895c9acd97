#include "common/disparity_range.hpp"

#include <sstream>

#include "quadedge/error.hpp"

namespace quadedge {

Config with_disparity_range(Config config, const StereoRig& rig) {
  if (config.stereo.max_disparity != 0 || config.stereo.min_depth != 0) return config;
  check_disparity_range(rig, "stereo rig");
  config.stereo.max_disparity = rig.disparity_range();
  return config;
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
