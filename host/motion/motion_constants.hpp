#pragma once
/// \file motion_constants.hpp  Constants that decide about motions (doc/method.md section 7) and that no recording
/// has needed to adjust. The others are in quadedge/constants.inc.

namespace quadedge::motion {

/// Fraction of the inlier distance that counts as close agreement. In fine texture, edges agree with a wrong position
/// by chance, less often at a smaller distance. Of two motions that differ by a pixel or two, only one agrees closely.
constexpr double kCloseAgreement = 1.0 / 3.0;

/// In an image cell that shows another motion, less than this fraction of the edges found again is explained by the
/// motion. A cell counts as having found at least kMinFoundRatio of its edges in view.
constexpr double kMinExplainedRatio = 0.25, kMinFoundRatio = 0.1;

/// Edges of a cell that must follow a second motion and not the first, since a single one may do so by chance.
constexpr double kMinCellEdges = 2;

/// Fraction of the edges in view that lie in such cells, above which another motion is searched for. Rendered scenes
/// reach 0.02, EuRoC 0.07, KITTI mostly 0.15 to 0.21; a motion that is not the camera's fails to explain more of the
/// image than it explains.
constexpr double kSecondaryMotionRatio = 0.25;

/// A motion with more than this fraction of the edges in view in such cells is a compromise between motions or
/// accidental.
constexpr double kMinorityMotionRatio = 0.5;

/// A motion that this fraction of the global matches agree with is not that of a minority: between distant views, most
/// edges are not found again. Key frames of EuRoC V1_01 reach 0.54 in nine of ten frames.
constexpr double kConfirmedGlobalRatio = 1.0 / 3.0;

/// A part of the image that moves otherwise counts above these fractions of all image cells and of those that the
/// chosen motion does not explain. Sound recordings reach 0.06 and 0.16; boards over 40 % of recordings 0.08 to 0.44.
constexpr double kElsewhereArea = 0.08, kElsewhereRatio = 0.12;
/// The same for parts on all sides, which are less likely those of an object: their standard deviation over the image
/// reaches this fraction of that of all cells.
constexpr double kSurroundingArea = 0.025, kSurroundingRatio = 0.1, kSurroundingSpread = 0.6;
/// The limits of areas and ratios are this fraction of those if the last motion was in doubt: a motion elsewhere that
/// is found in one frame is seldom gone in the next.
constexpr double kDoubtfulElsewhere = 0.25;

/// Lists of edges in cells that the chosen motion does not explain are thinned once they reach temporal.wide_edges (of
/// the current rig: twice that), but to no fewer than it divided by this. This finds as many boards in front of a
/// street as a search with twice as many edges.
constexpr int kElsewhereThinning = 2;

/// The rest of the image is searched for another motion after this number of frames, or earlier if the moving ratio has
/// risen to kCheckedMovingRatio and by kMovingRatioStep; at the start, after a loss and after one was found, in each of
/// the next kRechecks frames.
constexpr int kCheckInterval = 10, kRechecks = 3;
constexpr double kCheckedMovingRatio = 0.1, kMovingRatioStep = 0.1;

/// Two motions whose explained areas have a ratio above this are ambiguous.
constexpr double kCompetingAreaRatio = 0.4;

/// A motion that after the first round explains less than this fraction of the area that another one explains gets no
/// further rounds: these have added at most a quarter, which leaves it below kCompetingAreaRatio.
constexpr double kHopelessAreaRatio = 0.75 * kCompetingAreaRatio;

/// Fraction of the quads that are static although the motion would have moved them. Valid motions reach 0.036 in single
/// frames and are mostly below 0.001; a stationary camera whose motion was estimated from objects moving in front of it
/// has 0.07 to 0.36.
constexpr double kStaticQuadRatio = 0.05;

/// Two motions that share more than this fraction of the inliers are the same motion.
constexpr double kSharedInlierRatio = 0.7;

/// Support that a wrong motion may reach by chance in fine texture.
constexpr double kChanceSupport = 0.2;

/// A motion is confident if it reaches this fraction of the support that recent motions had.
constexpr double kRecentSupportRatio = 0.5;

/// Decay of the recent support per frame.
constexpr double kSupportDecay = 0.95;

/// Minimum inlier ratio of a proposed motion; low, because the confirmation follows.
constexpr double kProposalMinInlierRatio = 0.03;

/// The confirmation ends when the predicted positions change by less than this on average [px], far below
/// temporal.radius. The mean is computed over every 16th edge, which suffices for an average.
constexpr double kSettled = 0.3;
constexpr int kSettledStep = 16;

/// A proposal whose predicted positions are this close on average to those of a confirmed motion [px] is fitted to the
/// quads of that motion first, which lie within temporal.radius of both.
constexpr double kNearKnown = 1;

}  // namespace quadedge::motion
