/// \file poor_images.cpp  Counts of saturated corners, ratio of brightness.
#include "rig/poor_images.hpp"

#include <algorithm>

#include "common/printed.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {
namespace {

bool is_uneven(const CornerSearch& search) {
  return std::max(search.brightness, 1 / std::max(search.brightness, 1e-3)) > kUnevenBrightness;
}

}  // namespace

bool hides_corners(const CornerSearch& search) {
  return is_uneven(search) && search.more_saturated > kUnevenSaturation;
}

std::string poor_images(const CornerSearch& search, const std::string& seen) {
  const double saturated = static_cast<double>(search.saturated) / std::max(1, search.searched + search.saturated);
  if (saturated > kSaturatedRatio)
    return printed("%.0f %% of the corners lie beside saturated pixels", 100 * saturated) + seen +
           ": is the exposure too long?";
  if (!is_uneven(search)) return {};
  return printed("the right image is %.1f times as bright as the left one", search.brightness) + seen +
         ": do both cameras have the same exposure and gain?";
}

}  // namespace quadedge::rig
