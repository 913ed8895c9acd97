#pragma once
/// \file memory_fit.hpp  Fits the number of edges to the memory of a device.

#include <cstddef>
#include <string>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge::frontend {

/// A configuration that fits into memory.
struct MemoryFit {
  Config config;
  std::string message;  ///< empty if nothing was changed, otherwise a message for the user
};

/// Lowers edges.budget and edges.max_edges if the memory of a device might not suffice. The estimate is conservative:
/// 160 bytes per pixel of the left image, and 5 KB per edge of an image, twice the demand of the rendered scenes; for
/// the method of the paper, which has no budget, 320 bytes and 12 KB. \throws DeviceError if the images alone need too
/// much memory
MemoryFit fit_memory(const StereoRig& rig, const Config& config, std::size_t memory_bytes);

/// Whether a buffer of `bytes` fits beside what fit_memory() reckons with.
bool fits_beside(const StereoRig& rig, const Config& config, std::size_t bytes, std::size_t memory_bytes);

}  // namespace quadedge::frontend
