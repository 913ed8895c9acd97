#pragma once
/// \file edge_thinning.hpp  Plain C++ twin of kernels/edge_thinning.cl.

#include <cstdint>
#include <vector>

#include "quadedge/edges.hpp"

namespace quadedge::reference {

/// One token per pixel along a curve: an edge is kept unless the same pixel (nearest to its position) holds a stronger
/// edge whose direction is within 45 degrees, modulo 360; of equals the first one is the stronger. One flag per edge.
std::vector<std::uint8_t> kept_by_thinning(const EdgeSet& edges);

}  // namespace quadedge::reference
