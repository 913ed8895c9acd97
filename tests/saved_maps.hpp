#pragma once
/// \file saved_maps.hpp  Maps of small rendered recordings, for tests.

#include "testing.hpp"

namespace saved_maps {

/// A recording of a scene in small images.
inline quadedge::SyntheticOptions small(const std::string& scene, const std::string& path, int frames) {
  auto options = rendering(320, 200, 184, frames, 2);
  options.scene = scene;
  options.path = path;
  options.baseline = 0.15;
  return options;
}

/// A walk around a room.
inline quadedge::SyntheticOptions walk(const std::string& scene) { return small(scene, "loop", 49); }

/// The map of every second frame of a recording, all of which may become keyframes of the map.
inline quadedge::SavedMap map_of(const quadedge::SyntheticOptions& options, const std::string& device_name) {
  const quadedge::SyntheticSequence sequence(options);
  quadedge::Device device(device_name, kept_programs());
  quadedge::Config config;
  config.odometry.key_max_frames = 1;
  quadedge::StereoOdometry odometry(sequence.rig(), device, config);
  quadedge::Map map(odometry);
  for (int i = 0; i < sequence.frames(); i += 2) map.add(odometry.track(sequence.pair(i).view()));
  return map.saved();
}

/// The map of a room, made once.
inline const quadedge::SavedMap& room_map() {
  static const quadedge::SavedMap map = map_of(walk("room"), "0");
  return map;
}

}  // namespace saved_maps
