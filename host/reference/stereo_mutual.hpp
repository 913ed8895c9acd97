#pragma once
/// \file stereo_mutual.hpp  Plain C++ twin of kernels/stereo_mutual.cl.

#include "common/epipolar_geometry.hpp"
#include "reference/stereo_relaxation.hpp"

namespace quadedge::reference {

/// Keeps a left edge if the best left edge of its right edge, by the score of the relaxation, is itself or lies within
/// `mutual_radius` on the same curve, and collects the survivors in the order of their left edges.
///
/// Third-order edges hold about two tokens per pixel in either image, so neighbouring left edges can correctly match
/// the same right token at different points of their curve. Requiring unique right edges (`mutual_radius` = 0) would
/// remove a fifth of the result for hardly any gain in precision (doc/method.md section 3).
StereoEdges stereo_mutual(const StereoClusters& clusters, const StereoRelaxation& relaxation, const EdgeSet& left,
                          const EpipolarGeometry& geometry, const StereoConfig& config);

}  // namespace quadedge::reference
