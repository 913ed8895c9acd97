#pragma once
/// \file common_view.hpp  What only one of the cameras sees: an edge there has no partner, and would only use up the
/// budget of edges.

#include "quadedge/camera.hpp"

namespace quadedge::frontend {

/// What either mask hides. Masks of the same camera; an empty one hides nothing.
PixelMask joined(PixelMask mask, const PixelMask& other);

/// The rig with masks that also hide the pixels whose points, at whatever depth, lie outside the other image. Those of
/// a rectified rig with equal cameras hide no more than before.
StereoRig within_common_view(StereoRig rig);

}  // namespace quadedge::frontend
