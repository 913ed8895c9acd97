#pragma once
/// \file odometry_constants.hpp  Constants that decide about motions (doc/method.md section 7) and that no recording
/// has needed to adjust. The others are in quadedge/constants.inc.

#include <cstddef>

namespace quadedge::odometry {

/// Coarse search without a global one: radius [image width] without a prediction or after it failed.
constexpr double kLargeRadiusRatio = 0.1;

/// Inlier distance of global matches [px], since a match may be a neighbour of the correct edge.
constexpr double kGlobalInlierDistance = 4.0;

/// At the start temporal.global_edges divided by this are matched globally first. Their motion is followed if at least
/// this ratio of the matches agrees, in this many times pose.min_inliers cells: enough to decide between motions, which
/// the frames 1 of all recordings at hand reach twice over.
constexpr int kFewMatchesThinning = 3, kFewMatchesCells = 4;
constexpr double kFewMatchesRatio = 0.5;

/// A motion with less support must agree with the global matches.
constexpr double kConfidentSupport = 0.35;

/// Fraction of the inlier distance that counts as close agreement. In fine texture, edges agree with a wrong position
/// by chance, less often at a smaller distance. Of two motions that differ by a pixel or two, only one agrees closely.
constexpr double kCloseAgreement = 1.0 / 3.0;

/// In an image cell that shows another motion, less than this fraction of the edges found again is explained by the
/// motion. A cell counts as having found at least kMinFoundRatio of its edges in view.
constexpr double kMinExplainedRatio = 0.25, kMinFoundRatio = 0.1;

/// Probability by which so few edges of a cell agree with the motion that the rest of the image follows, below which
/// the cell moves: of 400 cells, every other frame shows one by chance.
constexpr double kChanceOfCell = 1e-3;

/// Edges of a cell that must follow a second motion and not the first, since a single one may do so by chance.
constexpr double kMinCellEdges = 2;

/// Fraction of the edges in view that lie in such cells, above which another motion is searched for: a motion that is
/// not the camera's fails to explain more of the image than it explains.
constexpr double kSecondaryMotionRatio = 0.25;

/// A motion with more than this fraction of the edges in view in such cells is a compromise between motions or
/// accidental.
constexpr double kMinorityMotionRatio = 0.5;

/// A motion that this fraction of the global matches agree with is not that of a minority: between distant views, most
/// edges are not found again.
constexpr double kConfirmedGlobalRatio = 1.0 / 3.0;
/// Nor is one that fewer agree with, if each other motion that they propose has fewer than this many per match of it:
/// the rest are mismatches, which propose nothing.
constexpr double kRivalRatio = 0.5;

/// A part of the image that moves otherwise counts above these fractions of all image cells and of those that the
/// chosen motion does not explain.
constexpr double kOtherPartArea = 0.08, kOtherPartRatio = 0.12;
/// An object that passes is no doubt: a rival explains this part of what the chosen motion explains, or of that this
/// part after an ambiguous motion.
constexpr double kRivalShare = 0.15, kRepeatedShare = 0.075;
/// Inliers of a motion of the rest of the global matches, in units of those of the motion that left them, below which
/// it is no rival: mismatches.
constexpr double kRestRatio = 0.05;
/// What near edges leave of a motion between distant views looks like another one, in few of the cells searched: either
/// more of these follow a rival, or it has kPromisingBalance of the matches.
constexpr double kCoherentRatio = 0.3;
/// The same for parts on all sides, which are less likely those of an object: their standard deviations over the image,
/// in x and in y, reach this fraction of those of all cells.
constexpr double kSurroundingArea = 0.025, kSurroundingRatio = 0.1, kSurroundingSpread = 0.6,
                 kRepeatedSpread = 0.3;  // of the matches of a motion that prevails, after an ambiguous one
/// In the first kRechecks motions, for which none before speak, a part that spreads over this suffices.
constexpr double kStartSpread = 0.3;
/// Global matches of a proposal alone over those of the chosen motion, from which it is worth a guided search.
constexpr double kPromisingBalance = 0.1;
/// The limits of areas and ratios are this fraction of those if the last motion was ambiguous: another motion that
/// is found in one frame is seldom gone in the next.
constexpr double kRepeatedOtherPart = 0.25;

/// Lists of edges in cells that the chosen motion does not explain are thinned once they reach temporal.global_edges
/// (of the current frame: twice that), but to no fewer than it divided by this.
constexpr int kFreeCellThinning = 2;

/// The rest of the image is searched for another motion after this number of frames, or earlier if the moving ratio has
/// risen to kCheckedMovingRatio and by kMovingRatioStep; at the start, after a loss and after one was found, in each of
/// the next kRechecks frames. If it has risen by kAppearanceStep to more than kMinorityMotionRatio, something may have
/// appeared that only the next frames' edges can show and that their motions may follow: it is searched for in these.
constexpr int kCheckInterval = 10, kRechecks = 3;
constexpr double kCheckedMovingRatio = 0.1, kMovingRatioStep = 0.1, kAppearanceStep = 0.25;

/// Two motions whose explained areas have a ratio above this are ambiguous.
constexpr double kCompetingAreaRatio = 0.4;

/// Fraction of the area that a motion has to explain, below which it gets no further round: these have added at most a
/// quarter. Beside another motion, that is what makes it ambiguous.
constexpr double kFirstRoundArea = 0.75, kHopelessAreaRatio = kFirstRoundArea * kCompetingAreaRatio;

/// Fraction of the quads that are static although the motion would have moved them, above which the camera may be
/// stationary.
constexpr double kStaticQuadRatio = 0.05;
/// Near edges that only standstill fits well count as static if they are so many times those that only the motion fits.
constexpr double kStillNearEdges = 2;

/// Edges at rest on all sides of what moves may be all that shows the scene: the part of the edges found near
/// standstill from which they count, and of those explained closely the part that is exact. Sound recordings reach 0.15
/// and 0.53, a scene behind a board over three quarters of the image 0.12 to 0.52 and 0.72 to 0.95.
constexpr double kStillAround = 0.1, kExactStill = 0.65;

/// The camera seems to stand still if more than the first fraction of the quads is static. If more than the second
/// fraction of the image cells do not follow, spread over the image as a surrounding part is, they may be all that
/// shows the scene.
constexpr double kStillQuadRatio = 0.8, kMovingSidesRatio = 0.05;

/// A motion does not take the place of the prediction's if that has so many times its inliers, and follows as many
/// cells: a view of equal objects, one of which appears in the place of the other, fits the few edges left in view
/// best.
constexpr int kRareMotion = 4;

/// Two motions that share more than this fraction of the inliers are the same motion.
constexpr double kSharedInlierRatio = 0.7;

/// Beside another motion, standstill is tried with all edges if those that support it among every kStillStep-th are
/// this fraction of those that a motion needs among all.
constexpr int kStillStep = 4;
constexpr double kStillSupport = 0.5;

/// Support that a wrong motion may reach by chance in fine texture.
constexpr double kChanceSupport = 0.2;

/// A motion is confident if it reaches this fraction of the support that recent motions had.
constexpr double kRecentSupportRatio = 0.5;

/// Decay of the recent support per frame.
constexpr double kSupportDecay = 0.95;

/// Minimum inlier ratio of a proposed motion; low, because the confirmation follows.
constexpr double kProposalMinInlierRatio = 0.03;

/// The guided search is repeated at most this often, around the motion that it found.
constexpr int kGuidedRounds = 3;

/// It ends when the predicted positions change by less than this on average [px], far below temporal.radius. The mean
/// is computed over every 16th edge, which suffices for an average.
constexpr double kSettled = 0.3;
constexpr int kSettledStep = 16;

/// Keyframes with different views that are kept for a loss, how many of them a lost frame is compared with, and the
/// difference between the directions to points [rad] up to which two of them say the same of its pose.
constexpr std::size_t kEarlierRigs = 12, kEarlierTrials = 6;
constexpr double kSamePlace = 0.05;

/// A proposal whose predicted positions are this close on average to those of a confirmed motion [px] is fitted to the
/// quads of that motion first, which lie within temporal.radius of both.
constexpr double kNearKnown = 1;

}  // namespace quadedge::odometry
