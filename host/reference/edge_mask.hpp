#pragma once
/// \file edge_mask.hpp  Plain C++ twin of kernels/edge_mask.cl. doc/method.md section 1.

#include "quadedge/camera.hpp"
#include "reference/edge_detection.hpp"

namespace quadedge::reference {

/// The edges that are not within `margin` [px] of hidden pixels, in their order; all of them without a mask.
ReferenceEdges outside_mask(const ReferenceEdges& edges, const PixelMask& mask, int margin);

}  // namespace quadedge::reference
