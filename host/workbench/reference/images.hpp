#pragma once
/// \file images.hpp  Plain C++ twins of stage 1: recorded images as pinhole images, smoothed where noise hides the
/// edges.

#include "quadedge/camera.hpp"
#include "quadedge/image.hpp"

namespace quadedge::reference {

// Plain C++ twin of kernels/undistortion.cl.

/// undistort() of geometry/undistortion.hpp; without a table, a copy of the recorded image.
Image pinhole_image(const ImageView& recorded, const UndistortionTable& table);

// Plain C++ twin of kernels/smoothing.cl: a noisy image, smoothed. doc/method.md section 1.

/// The image convolved along both axes with the binomial coefficients of order 16: border replicated, rounded half up.
Image smoothed(const ImageView& image);

}  // namespace quadedge::reference
