#pragma once
/// \file rig_constants.hpp  Constants that decide whether images fit the calibration (doc/method.md section 7). No
/// recording has needed to adjust them.

#include <cstddef>

namespace quadedge::rig {

// Corners (patch_search.cpp).

/// Correlation of two patches from which they count as a match, also of aligned ones.
constexpr double kMinCorrelation = 0.8;
/// A match is unique if its correlation exceeds all others in the search area by this.
constexpr float kUniqueMargin = 0.03F;
/// Patches with a lower standard deviation count as flat [grey levels].
constexpr double kFlat = 1.5;
/// Size of the cells that yield one corner each [px].
constexpr int kCell = 20;
/// Minimum of the smaller eigenvalue of the structure tensor, per pixel [(grey levels per px)^2].
constexpr double kMinCorner = 4;

// Their refined matches (corner_matching.cpp).

constexpr int kAlignedSpots = 240;
constexpr float kSaturated = 254.5F;  ///< grey level from which a pixel is saturated
/// A refinement takes at most this many steps, ends when a step is shorter than kSettledShift, and is dropped when it
/// leaves kMaxShift around its start [px].
constexpr int kAlignmentSteps = 10;
constexpr double kSettledShift = 0.01, kMaxShift = 4;
/// Determinant over squared trace of the structure tensor; 0.25 for an isotropic corner.
constexpr double kMinRoundness = 0.03;
/// Matches with a larger error across the line do not constrain the distance from it [px].
constexpr double kMaxSigma = 0.1;
/// Extent of the search, as fractions of the left image's width and height; to the last left image, of its width.
constexpr double kSearchAlong = 0.25, kSearchAcross = 0.1, kSearchMotion = 0.1;
/// Width of the image that the search reads [px].
constexpr double kCoarseWidth = 320;

// The fit of their distances from the lines (corner_matching.cpp).

constexpr double kMinScale = 0.02;  ///< px

// What all frames show of the rows (row_model.cpp).

constexpr double kRowMemory = 100;        ///< frames
constexpr double kTermSigmas = 4;         ///< standard deviations below which a term counts as 0
constexpr double kMeanSquare = 1.0 / 12;  ///< of a coordinate from -1/2 to 1/2

// When the corners are searched for again (rig_monitor.cpp).

constexpr int kSearchPeriod = 50;  ///< frames
/// Decrease of the ratio of matched edges, and increase of the residual [px], since the last search.
constexpr double kMatchedDecrease = 0.7, kResidualIncrease = 0.2;

// Findings (rig_monitor.cpp).

constexpr int kMinCorners = 20;
constexpr std::size_t kMinMatches = 12;
/// The search that only confirms that a rig still is right takes every so many-th corner.
constexpr std::size_t kSparseCorners = 3;
/// Fraction of the corners that are found.
constexpr double kLostFoundRatio = 0.2;
/// Fraction of the left edges that have a match.
constexpr double kLostMatchedRatio = 0.1;
constexpr double kMajority = 0.5;
/// Fraction of the corners found that exceed the range.
constexpr double kWarningRatio = 0.1;
/// Distance from the line beyond which an edge lies outside the patches that the cascade compares (half side 3.5 px).
/// [px]
constexpr double kLostResidual = 3;
/// Distance from the line that the cascade searches; a fit that leaves more explains nothing. [px]
constexpr double kDoubtfulResidual = 0.5;
/// If more of the edges than this have a match on their epipolar lines, the corners off their lines are mostly on thin
/// structures.
constexpr double kReliableMatchedRatio = 0.65;
/// The fit is not believed if more of the edges than the last number are matched and this fraction of the corners lies
/// within kOnLine of the lines where the fit says kOffLine or more [px].
constexpr double kOnLine = 1, kOffLine = 2, kContradictingRatio = 0.1, kCertainMatchedRatio = 0.75;
/// Fraction of aligned corners on their lines from which images fit the calibration and are of one moment, however few
/// are found; sound recordings reach 0.77, neighbours in time 0.5 where the image moves.
constexpr double kSoundOnLine = 0.7;
/// Learned disparity offset. [px]
constexpr double kMaxOffset = 1.5;

// Displaced images (learned_rig.cpp, image_jump.cpp).

/// A right image that is displaced along the epipolar lines: the displacement from which the first kDisplacedFrames of
/// a recording count, and later ones [px], and its standard deviations.
constexpr double kFirstJump = 0.6, kLaterJump = 0.1, kJumpSigmas = 10;
constexpr int kDisplacedFrames = 2;
/// Ratio of the areas explained with and without a displacement, for the first ones. The differences of two frames of
/// KITTI, whose rig is rigid, resemble displacements up to 0.7 px, with ratios up to 1.8.
constexpr double kFirstGain = 3;
/// Standard deviation of a displacement measured against another frame's [px], beside that of its fit: what the matches
/// of a frame share.
constexpr double kJumpSigma = 0.1;
/// Standard deviation of the displacements of a recording before they are known [px], the frames for which this counts,
/// and those that count.
constexpr double kSwing = 1, kSwingFrames = 5, kSwingMemory = 100;
/// Median distance of the disparities from the motion that explains them, over the displacement, at most.
constexpr double kJumpScatter = 0.5;
constexpr std::size_t kMinJumpMatches = 60;
constexpr double kLeastJumpScale = 0.05;  ///< of a disparity in the robust fit [px]

// Images that are bad (corner_judgement.cpp).

/// Corners beside saturated pixels over all, from which images are called saturated.
constexpr double kSaturatedRatio = 0.3;
/// Brightness of the right image over the left one's, or the other way round, from which they are unevenly lit, and the
/// difference of their saturated parts that hides corners.
constexpr double kUnevenBrightness = 1.5, kUnevenSaturation = 0.15;

// Lens errors that both cameras share (shared_lens.cpp).

/// A motion that turns by this [rad] counts, every kLensEvery-th of them, since successive ones share their edges;
/// quads of it that are looked at, about, and the least number of their rows.
constexpr double kLensTurn = 0.005;
constexpr int kLensEvery = 3;
constexpr std::size_t kLensQuads = 300, kLensRows = 150;
/// Noise of an edge across itself, and of a disparity [px].
constexpr double kLensEdgeSigma = 0.12, kLensDisparitySigma = 0.2;
/// How far focal lengths (as a part) and k1 may be off, as standard deviations, before anything is known.
constexpr double kFocalRange = 0.5, kLensRange = 0.1;
/// How far disparities may change over the image [px], likewise.
constexpr double kSlopeRange = 5;
/// Errors of the edges of a motion are not independent: standard deviations are larger by this.
constexpr double kLensInflation = 4;
/// What is reported: errors of so many standard deviations, and at least of this part and this k1. Rigs at hand have up
/// to 0.035 and 0.003 (KITTI's and Karlsruhe's, which are known to be off; EuRoC's 0.008 and 0.003).
constexpr double kLensSigmas = 4, kWrongFocal = 0.04, kWrongLens = 0.015;
/// Standard deviation of the focal lengths from which on no more is learned.
constexpr double kSettledFocal = 0.004;

// Parts of the image that do not move (static_region.cpp).

/// Size of the squares that are compared, and the distance between two of them [px]; those side by side are cells.
constexpr int kStaticCell = 16, kStaticStep = 4;
/// Frames from the first to the last comparison, and between two of them.
constexpr int kStaticWindow = 20, kStaticPeriod = 4;
/// Static part of the textured cells from which nothing has moved yet, so that the window starts anew.
constexpr double kRestRatio = 0.95;
/// Cells with a lower standard deviation of the reduced grey levels count as flat [grey levels].
constexpr double kStaticTexture = 4;
/// Correlation with the start of the window, from which a cell is static and below which it has changed.
constexpr double kStaticCorrelation = 0.9, kChangedCorrelation = 0.5;
/// Static part of the textured cells, and the part that has to change.
constexpr double kMinStaticRatio = 0.05, kMinMovingRatio = 0.3;
constexpr int kMinStaticMatches = 20;
/// Frames after which a region may be certain.
constexpr int kCertainAfter = 12;
/// A region with more of the textured cells than the first is certain if more of them than the second change on all
/// sides, with a variance of the places, in x and in y, of at least this part of that of all; unless its inverse depths
/// are below this part of those of what changes: it may then be distant scenery.
constexpr double kMinSurroundedRatio = 0.3, kMinSurroundingRatio = 0.05, kSurroundingVariance = 0.8;
constexpr double kSurroundedNearness = 1.0 / 3;

// The time between the two images (rig_monitor.cpp, row_model.cpp).

constexpr double kTimeMemory = 20;  ///< frames
constexpr int kMinSamples = 60;
/// Median displacement of a frame's corners from which they count [px].
constexpr double kMinImageMotion = 1;
/// Standard deviations of the time; many, because the errors of neighbours are correlated.
constexpr double kMinTimeSigmas = 10;
constexpr double kMinTimeOffset = 0.3;  ///< frame intervals
/// From here on another frame would be the better partner [frame intervals].
constexpr double kWrongPartner = 0.5;
/// A camera that is later than this shows another motion, to which distances are not proportional [frame intervals].
constexpr double kMaxTimeOffset = 8;
/// Corners on their lines as the images are paired, over those with a delay, up to which the delay is believed.
constexpr double kLeftLines = 0.6;
/// Frames in a row that are searched for the time between the images, if they may show different moments.
constexpr int kTimeSearches = 5;

}  // namespace quadedge::rig
