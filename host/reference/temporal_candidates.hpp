#pragma once
/// \file temporal_candidates.hpp  Plain C++ twin of kernels/temporal_candidates.cl.

#include "common/filter_limits.hpp"
#include "reference/point_index.hpp"
#include "reference/stereo_candidates.hpp"

namespace quadedge::reference {

/// Filters 1 and 2 of doc/method.md section 4 in one image: current edges within `radius` [px] of the predicted
/// position and within `orientation` [rad, modulo a full turn] of the predicted direction. Row r belongs to predicted
/// edge r * row_step; targets are in the order of the point index.
Candidates temporal_candidates(const EdgePositionsView& predicted, const EdgePositionsView& current,
                               const PointIndex& index, float radius, float orientation, int row_step = 1);

}  // namespace quadedge::reference
