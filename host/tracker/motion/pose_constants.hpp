#pragma once
/// \file pose_constants.hpp  Constants of the pose estimate (doc/method.md section 6) that need no adjustment to data.
/// The others are in quadedge/constants.inc.

#include <cstddef>

#include "quadedge/camera.hpp"

namespace quadedge::pose {

/// Equation 9 of the paper: relative difference of the lengths of D; differences of the cosines between D and a tangent
/// and between the tangents; minimum angle between D and a tangent; determinant above which the handedness must agree.
constexpr double kLengthDifference = 0.13, kAngleDifference = 0.12, kTangentDifference = 0.32, kMinAngleDeg = 14.0,
                 kMinDeterminant = 0.1;

/// Maximum difference of directions of an inlier (section 6 of the paper).
constexpr double kInlierOrientation = 10.0 * kDegree;

/// RANSAC: probability of having drawn an outlier-free sample at which the search ends, and the maximum number of
/// hypotheses, by which it ends at inlier ratios above 6 %.
constexpr double kConfidence = 0.999;
constexpr int kMaxHypotheses = 2000;

/// Number of inlier selections, each followed by a fit: further ones change hardly any row.
constexpr int kRefineRounds = 4;

/// Standard deviations of an edge's position along the edge [px] and of its direction in the image [rad].
constexpr double kSigmaAlong = 0.5, kSigmaDirection = 2.0 * kDegree;

/// Covariance inflation: side of the smallest square cells whose edges may share their error [px].
constexpr double kInflationCell = 16.0;

/// Maximum number of Gauss-Newton steps of a fit: one that needs more started from a wrong motion.
constexpr int kFitSteps = 5;

/// Step length below which a fit ends [standard deviations of the pose], far below the effect of noise.
constexpr double kFitTolerance = 0.05;

/// Number of quads on which all hypotheses are compared, and of those on which the promising ones are.
constexpr std::size_t kPreviewQuads = 512, kScoringQuads = 4096;

/// Minimum distance in the image of the two quads of a sample [image diagonals].
constexpr double kMinPairDistance = 0.05;

/// Draws per pair of quads after which hardly any pair has not been drawn; the same pair gives the same hypothesis.
constexpr double kDrawsPerPair = 10;

/// Draws times the square of the least inlier ratio after which no consensus of that size is left to be found: with
/// kConfidence, a pair of its inliers was drawn that passes the tests of pairs, as one in ten does.
constexpr double kDrawsForConsensus = 70;

/// Approximate number of quads that determine the inlier selection, and of errors over which a scale is computed as the
/// median: the median of 4000 is known to 2 %.
constexpr std::size_t kSelectionQuads = 4000, kScaleErrors = 4000;

/// If the selection changes in fewer than one row out of this many, no further fit is made.
constexpr std::size_t kSameSelection = 100;

/// Lower limit of the ratio of measured to assumed variances, for noise-free data.
constexpr double kSmallestScale = 1e-6;

/// Systematic errors of positions and of disparities that may look like an offset of all disparities [px].
constexpr double kSystematicPosition = 0.02, kSystematicDisparity = 0.02;
/// Variance of the part of them that is a frame's own, over that of the part that all frames share.
constexpr double kOwnSystematic = 4;
/// Deviation of a measured offset from what is known of it, in standard deviations; a larger one has a larger error.
constexpr double kMostDeviation = 4;

/// Minimum ratio of the pivots of the normal equations, after scaling the diagonal to one.
constexpr double kSmallestPivot = 1e-12;

/// Standard deviation of depth slopes in typical scenes: surfaces slanted by 45 degrees, for any camera.
constexpr double kSlopePrior = 1.0;

/// Cell sizes within which errors may be correlated: kInflationCell and its doublings. From index kLeftOut on,
/// the cells are left out in turn.
constexpr int kCellSizes = 5, kLeftOut = 2;

/// A cell with more than this fraction of the information cannot be left out.
constexpr double kLargestRatio = 0.5;

}  // namespace quadedge::pose
