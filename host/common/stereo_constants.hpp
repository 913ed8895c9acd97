#pragma once
/// \file stereo_constants.hpp  Constants of the stereo cascade (doc/method.md section 3) that no data asks to turn. The
/// others stand in quadedge/constants.inc.

namespace quadedge {

/// Huber threshold of the photometric refinement [grey levels]: images of all cameras have 256 of them, and a pixel
/// that differs by more shows another surface.
constexpr double kRefinementHuber = 3.0;

/// Longest move of the refinement along the line [px]: a candidate that has farther to go started on another edge.
constexpr double kRefinementClamp = 2.0;

/// Difference of two true patches [grey levels] that the prior of the refinement is weighed against. Only its ratio to
/// stereo.refine_prior_sigma counts, and that one can be turned.
constexpr double kRefinementNoise = 5.0;

/// Most members of a cluster: bounds how far neighbours chain up where no gap ends them.
constexpr int kClusterSizeMax = 10;

/// Standard deviation of the weights in a cluster's mean direction [px]: members a gap apart weigh nearly alike.
constexpr double kClusterSigma = 2.0;

}  // namespace quadedge
