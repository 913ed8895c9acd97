#pragma once
/// \file stereo_constants.hpp  Constants of the stereo cascade (doc/method.md section 3) that need no adjustment to
/// data. The others are in quadedge/constants.inc.

namespace quadedge {

/// Huber threshold of the photometric refinement [grey levels]. All images have 256 grey levels, and pixels that differ
/// by more show different surfaces.
constexpr double kRefinementHuber = 3.0;

/// Maximum displacement of the refinement along the line [px]: a candidate that is farther away belongs to another
/// edge.
constexpr double kRefinementClamp = 2.0;

/// Assumed difference between two matching patches [grey levels], against which the prior of the refinement is
/// weighted. Only its ratio to stereo.refine_prior_sigma, which is configurable, matters.
constexpr double kRefinementNoise = 5.0;

/// Maximum number of members of a cluster, which limits chains of neighbours without gaps.
constexpr int kClusterSizeMax = 10;

/// Standard deviation of the weights in a cluster's mean direction [px]; members one gap apart have nearly equal
/// weights.
constexpr double kClusterSigma = 2.0;

}  // namespace quadedge
