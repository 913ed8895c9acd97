#pragma once
/// \file stereo_candidates.hpp  Plain C++ twin of kernels/stereo_candidates.cl.

#include <cstdint>
#include <vector>

#include "common/epipolar_geometry.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::reference {

/// Candidate lists in compressed rows: row i owns first[i] .. first[i + 1] of target.
struct Candidates {
  std::vector<std::int32_t> first;   ///< rows + 1
  std::vector<std::int32_t> target;  ///< index of the other edge
};

/// Filters 1 to 3 of doc/method.md section 3 for every left edge. Needs right.row_first only to skip far rows.
Candidates stereo_candidates(const EdgeSet& left, const EdgeSet& right, const EpipolarGeometry& geometry,
                             const DisparityProbe& probe);

}  // namespace quadedge::reference
