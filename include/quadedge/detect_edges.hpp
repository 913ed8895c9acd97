#pragma once
/// \file detect_edges.hpp  Edges of a single image.

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/device.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"

namespace quadedge {

/// Third-order edges of one pinhole image, computed on `device`; none within edges.margin of the pixels hidden by
/// `mask`.
/// \throws DeviceError; UsageError if there are more than edges.max_edges edges; DataError if the stride is smaller
/// than a row.
EdgeSet detect_edges(const ImageView& image, Device& device, const Config& config = {}, const PixelMask& mask = {});

}  // namespace quadedge
