#pragma once
/// \file matching_constants.hpp  Constants of the stereo and temporal cascades (doc/method.md sections 3 and 4) that
/// need no adjustment to data. The others are in quadedge/constants.inc.

#include "quadedge/camera.hpp"

namespace quadedge {

/// Distance of the key points of SIFT from the edge [px] (section 5.1 of the paper).
constexpr double kSiftOffset = 8.0;

/// Minimum angle between an edge and its epipolar line: a position along the line is unknown to 1 / sine of the angle.
constexpr double kMinEpipolarAngleDeg = 4.0, kMinEpipolarAngle = kMinEpipolarAngleDeg * kDegree;

/// Candidates whose tangent is at least this angle off the epipolar line are shifted along it, by at most kShiftMax
/// [px]; the others are projected orthogonally, as the shift would amplify the error of their direction.
constexpr double kShiftMinAngle = 12.0 * kDegree, kShiftMax = 3.0;

/// Filter 7: minimum ratio of the best SIFT distance to a candidate's (section 5.1 of the paper).
constexpr double kSiftNearlyBest = 0.4;

/// Gap [px] (section 5.1 of the paper) and change of direction that separate two clusters.
constexpr double kClusterGap = 1.0, kClusterOrientation = 20.0 * kDegree;

/// Difference in similarity that makes a candidate e times as likely before the neighbours vote, and the weight of
/// their full support in units of similarity.
constexpr double kRelaxationScale = 0.04, kSupportWeight = 0.4;

/// Huber threshold of the photometric refinement [grey levels]. All images have 256 grey levels, and pixels that differ
/// by more show different surfaces.
constexpr double kRefinementHuber = 3.0;

/// Maximum displacement of the refinement along the line [px]: a candidate that is farther away belongs to another
/// edge.
constexpr double kRefinementClamp = 2.0;

/// Assumed difference between two matching patches [grey levels], against which the prior of the refinement is
/// weighted. Only its ratio to stereo.refine_prior_sigma, which is configurable, matters.
constexpr double kRefinementNoise = 5.0;

/// Distance of the patches' centres from the edge in the paper's refinement [px]; its code's, half a pixel less than
/// for the NCC. And the residual above which a free move is not taken over [grey levels].
constexpr double kPaperRefinementOffset = 4.5, kPaperLargestResidual = 6.0;

/// Maximum number of members of a cluster, which limits chains of neighbours without gaps.
constexpr int kClusterSizeMax = 10;

/// Standard deviation of the weights in a cluster's mean direction [px]; members one gap apart have nearly equal
/// weights.
constexpr double kClusterSigma = 2.0;

/// Maximum difference from the predicted direction, modulo 360 degrees (section 5.2 of the paper).
constexpr double kTemporalOrientationDeg = 10.0, kTemporalOrientation = kTemporalOrientationDeg * kDegree;

/// Coarse search: minimum NCC and minimum ratios to the best NCC and of the best SIFT distance (section 5.2 of the
/// paper). They are stricter than those of the search behind it, since its radius is larger.
constexpr double kCoarseNccMin = 0.8, kCoarseNccNearlyBest = 0.9, kCoarseSiftNearlyBest = 0.6;

/// Coarse search without a prediction: maximum SIFT distance (section 5.2 of the paper), which the NCC alone does not
/// replace in a large radius.
constexpr double kLargeRadiusSiftMax = 200.0;

/// Global search: maximum ratio of a descriptor distance to that of the best competitor at least kWideNeighbourhood
/// [px] away, where an edge no longer belongs to the same piece of curve.
constexpr double kWideRatio = 0.8, kWideNeighbourhood = 12.0;

}  // namespace quadedge
