#pragma once
/// \file memory_fit.hpp  How many edges a device's memory holds.

#include <cstddef>
#include <string>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge::frontend {

/// A configuration that fits.
struct MemoryFit {
  Config config;
  std::string message;  ///< empty where nothing had to be changed, or a sentence for the user
};

/// Lowers edges.budget, and edges.max_edges with it, where the memory of a device might run out. The estimate is on the
/// safe side: 160 bytes per pixel of the left image, and 5 KB per edge of an image, twice what the rendered scenes
/// take. \throws DeviceError where the images alone take too much.
MemoryFit fit_memory(const StereoRig& rig, const Config& config, std::size_t memory_bytes);

}  // namespace quadedge::frontend
