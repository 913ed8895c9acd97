#pragma once
/// \file saved_places.hpp  What a map file holds (doc/method.md section 10).

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "places/place_store.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge::places {

struct SavedPlaces {
  StereoRig rig;  ///< without undistortion tables and masks
  /// 1 if the recorded images had lens distortion, so that `rig` does not describe them.
  std::uint8_t is_undistorted = 0;
  /// Disparity offset that the odometry has learned [px], and its variance [px^2].
  double offset = 0, offset_variance = 0;
  std::vector<std::pair<std::string, std::string>> settings;  ///< descriptor_settings() of the recording
  PlaceStore store{std::numeric_limits<std::size_t>::max()};  ///< Place::node is an index of `poses`
  std::vector<Eigen::Isometry3d> poses;                       ///< map_from_left of every place [m]
};

/// \throws UsageError if `temporal.wide_edges` is 0 or a filter in time uses SIFT, because kept rigs have no images.
void check_map_config(const Config& config);

/// Keys and values of the constants that edges, patches and descriptors depend on, which have to be equal for all rigs
/// of a map and the frames located in it.
std::vector<std::pair<std::string, std::string>> descriptor_settings(const Config& config);

}  // namespace quadedge::places
