#include "places/saved_places.hpp"

#include <algorithm>
#include <array>

#include "quadedge/error.hpp"

namespace quadedge::places {

void check_map_config(const Config& config) {
  if (config.temporal.wide_edges == 0) throw UsageError("a map needs the global search: temporal.wide_edges above 0");
  if (config.temporal.sift_max > 0)
    throw UsageError("a map keeps no SIFT descriptors: expected temporal.sift_max of 0");
}

std::vector<std::pair<std::string, std::string>> descriptor_settings(const Config& config) {
  constexpr std::array<const char*, 3> kKeys = {"edges.sigma", "edges.direction_at", "patches.offset"};
  std::vector<std::pair<std::string, std::string>> settings;
  for (const Constant& constant : constants())
    if (std::find(kKeys.begin(), kKeys.end(), constant.key()) != kKeys.end())
      settings.emplace_back(constant.key(), constant.text(config));
  return settings;
}

}  // namespace quadedge::places
