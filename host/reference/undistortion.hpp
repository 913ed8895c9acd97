#pragma once
/// \file undistortion.hpp  Plain C++ twin of kernels/undistortion.cl.

#include "quadedge/camera.hpp"
#include "quadedge/image.hpp"

namespace quadedge::reference {

/// The pinhole image (table.height x table.width) of a recorded image: bilinear, border replicated, rounded half up.
Image undistort(const ImageView& recorded, const UndistortionTable& table);

/// The same; without a table, a copy of the recorded image.
Image pinhole_image(const ImageView& recorded, const UndistortionTable& table);

}  // namespace quadedge::reference
