#pragma once
/// \file layouts.hpp  Host view of kernels/layouts.cl: data that kernels store per edge, and structures that they take
/// by value.

namespace quadedge {

#include "../../../kernels/layouts.cl"  // shared source

#undef FLOAT_CONSTANT

static_assert(sizeof(int) == 4 && sizeof(float) == 4);
static_assert(kInverseNorms + 2 * sizeof(float) <= kEdgePatchBytes);

}  // namespace quadedge
