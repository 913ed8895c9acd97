#pragma once
/// \file layouts.hpp  kernels/layouts.cl as the host reads it: what kernels store per edge, and the structures that
/// they take by value.

namespace quadedge {

#include "../../kernels/layouts.cl"  // the one text of both

#undef FLOAT_CONSTANT

static_assert(sizeof(int) == 4 && sizeof(float) == 4);
static_assert(kInverseNorms + 2 * sizeof(float) <= kEdgePatchBytes);

}  // namespace quadedge
