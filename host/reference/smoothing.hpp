#pragma once
/// \file smoothing.hpp  Plain C++ twin of kernels/smoothing.cl: a noisy image, smoothed. doc/method.md section 1.

#include "quadedge/image.hpp"

namespace quadedge::reference {

/// The image convolved along both axes with the binomial coefficients of order 16: border replicated, rounded half up.
Image smoothed(const ImageView& image);

}  // namespace quadedge::reference
