#pragma once
/// \file detect_edges.hpp  Edge detection of a single image.

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/device.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"

namespace quadedge {

/// Third-order edges of one pinhole image on the chosen device; none within edges.margin of what `mask` hides.
/// \throws DeviceError, UsageError for more edges than edges.max_edges, DataError for a stride below a row's bytes.
EdgeSet detect_edges(const ImageView& image, Device& device, const Config& config, const PixelMask& mask = {});

}  // namespace quadedge
