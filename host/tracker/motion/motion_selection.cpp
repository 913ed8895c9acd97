/// \file motion_selection.cpp  The largest explained area wins; thresholds on ratios tell doubts and refusals.
#include "motion/motion_selection.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/printed.hpp"
#include "motion/motion_step.hpp"
#include "motion/odometry_constants.hpp"

namespace quadedge::odometry {
namespace {

/// Whether a motion is too rare to be the camera's beside one that the prediction proposed.
bool is_rare(const Verdict& verdict, const Verdict& predicted) {
  return kRareMotion * verdict.inliers <= predicted.inliers && verdict.followed <= predicted.followed;
}

/// The motion that explains the largest area, unless it is a rare one beside the prediction's. Of equal ones, such as
/// two failures, one that does not rely on the prediction takes precedence, then the first.
std::size_t largest(const std::vector<Verdict>& verdicts, const std::optional<std::size_t>& predicted) {
  const Verdict* const expected = predicted && verdicts[*predicted].is_confirmed() && verdicts[*predicted].inliers > 0
                                      ? &verdicts[*predicted]
                                      : nullptr;
  const auto may_win = [&](const Verdict& of) { return expected == nullptr || !is_rare(of, *expected); };
  const auto beats = [&](std::size_t one, std::size_t other) {
    const Verdict &its = verdicts[one], &others = verdicts[other];
    if (its.is_confirmed() != others.is_confirmed()) return its.is_confirmed();
    if (its.is_confirmed() && may_win(its) != may_win(others)) return may_win(its);
    if (its.is_confirmed() && its.area != others.area) return its.area > others.area;
    return predicted == other;
  };
  std::size_t best = 0;
  for (std::size_t one = 1; one < verdicts.size(); ++one)
    if (beats(one, best)) best = one;
  return best;
}

/// The same motion with all of its inliers, if another hypothesis led to it.
std::size_t with_all_inliers(std::size_t chosen, const std::vector<Verdict>& verdicts, const Comparison& comparison) {
  if (!verdicts[chosen].is_confirmed() || verdicts[chosen].has_all_inliers) return chosen;
  for (std::size_t other = 0; other < verdicts.size(); ++other)
    if (verdicts[other].is_confirmed() && verdicts[other].has_all_inliers && comparison.is_same(chosen, other))
      return other;
  return chosen;
}

/// The largest area that a different motion explains and the chosen one does not, in units of the chosen motion's; 0 if
/// none competes.
double competing_area(std::size_t chosen, const std::vector<Verdict>& verdicts, const Comparison& comparison) {
  const double unit = verdicts[chosen].area;
  double largest = 0;
  for (std::size_t other = 0; other < verdicts.size(); ++other) {
    if (other == chosen || !verdicts[other].is_confirmed()) continue;
    const auto competes = [&](double area) { return area >= kCompetingAreaRatio * unit && area >= largest * unit; };
    if (!competes(verdicts[other].area) || comparison.is_same(chosen, other)) continue;
    const double area = comparison.area_beside(other, chosen);
    if (competes(area)) largest = unit > 0 ? area / unit : 1;
  }
  return largest;
}

/// Whether the global matches confirm a motion with which most of the image is not found again.
bool is_confirmed_globally(const Verdict& verdict) {
  if (verdict.global_ratio >= kConfirmedGlobalRatio) return true;
  return verdict.global_ratio > 0 && verdict.agrees_globally && verdict.rival_ratio < kRivalRatio;
}

Ambiguity ambiguity_of(std::size_t chosen, const std::vector<Verdict>& verdicts, const Comparison& comparison) {
  const Verdict& verdict = verdicts[chosen];
  if (verdict.moving_ratio > kMinorityMotionRatio && !is_confirmed_globally(verdict))
    return {AmbiguityKind::moving_image, verdict.moving_ratio};
  if (verdict.still_ratio > kStillQuadRatio && verdict.around_ratio > kMovingSidesRatio)
    return {AmbiguityKind::moving_sides, verdict.around_ratio};
  if (verdict.static_ratio > kStaticQuadRatio) return {AmbiguityKind::static_scene, verdict.static_ratio};
  const double area = competing_area(chosen, verdicts, comparison);
  return area > 0 ? Ambiguity{AmbiguityKind::competing_motion, area} : Ambiguity{};
}

/// A confident prediction that explains the image ends the search. If a part of the image moves differently, the
/// inexpensive hypotheses are tried as well; if most of it does, if the last motion was ambiguous, or if one of them
/// explains more, everything.
SearchLevel level_for(const Verdict& chosen, bool is_expected, bool was_ambiguous) {
  if (was_ambiguous || !is_expected || chosen.moving_ratio > kMinorityMotionRatio) return SearchLevel::everything;
  const bool is_open = chosen.moving_ratio > kSecondaryMotionRatio || chosen.static_ratio > kStaticQuadRatio;
  return is_open ? SearchLevel::inexpensive : SearchLevel::prediction;
}

/// A ratio as a percentage.
std::string percent(double ratio) { return std::to_string(std::lround(100 * ratio)) + " %"; }

}  // namespace

std::string to_string(const Ambiguity& ambiguity) {
  switch (ambiguity.kind) {
    case AmbiguityKind::none: return "";
    case AmbiguityKind::moving_image: return percent(ambiguity.ratio) + " of the image move differently";
    case AmbiguityKind::moving_sides:
      return percent(ambiguity.ratio) + " of the image, on all sides, move while the rest stands still";
    case AmbiguityKind::static_scene:
      return percent(ambiguity.ratio) + " of the edges are where they were, although the motion would have moved them";
    case AmbiguityKind::competing_motion:
      return "another motion explains " + percent(ambiguity.ratio) + " of the area that this one explains";
    case AmbiguityKind::repeated_scene:
      return printed("the scene repeats after %.2f m, and a motion that differs by that explains it as well",
                     ambiguity.ratio);
    case AmbiguityKind::other_part:
      return percent(ambiguity.ratio) + " of the image follow another motion and not this one";
    case AmbiguityKind::recent_other_part:
      return "parts of the image followed another motion in one of the last frames";
  }
  return "";
}

std::string refusal_text(const Verdict& verdict) {
  switch (verdict.refusal) {
    case Refusal::none: return "";
    case Refusal::too_few_quads: return "too few quads";
    case Refusal::no_consensus: return "no consensus";
    case Refusal::badly_spread: return "badly spread";
    case Refusal::little_support: return "too few of the edges in view follow the motion";
    case Refusal::duplicate: return "the motion of another hypothesis";
    case Refusal::contradicted: return "matches over the whole image do not follow the motion";
    case Refusal::ambiguous: return "ambiguous motion after a loss: " + to_string(verdict.ambiguity);
  }
  return "";
}

std::size_t select(std::vector<Verdict>& verdicts, const Expectation& expectation, const Comparison& comparison) {
  std::size_t index = with_all_inliers(largest(verdicts, expectation.predicted), verdicts, comparison);
  const std::optional<std::size_t>& predicted = expectation.predicted;
  const bool is_compared = predicted && verdicts[index].is_confirmed();
  bool is_predicted = is_compared && (index == *predicted || comparison.is_same(index, *predicted));
  if (is_compared && !is_predicted && verdicts[*predicted].is_confirmed() &&
      comparison.is_repeated(*predicted, index)) {
    index = *predicted;
    is_predicted = true;
  }
  Verdict& chosen = verdicts[index];
  chosen.is_predicted = is_predicted && !expectation.was_ambiguous;
  const bool is_expected =
      chosen.is_confirmed() && index == expectation.predicted && chosen.support >= expectation.confident_support;
  chosen.needed = level_for(chosen, is_expected, expectation.was_ambiguous);
  if (chosen.is_confirmed()) chosen.ambiguity = ambiguity_of(index, verdicts, comparison);
  if (!is_expected && !chosen.agrees_globally) chosen.refuse(Refusal::contradicted);
  return index;
}

void decide(bool accepts_ambiguous, const Ambiguity& later, Verdict& chosen) {
  if (!chosen.ambiguity.exists()) chosen.ambiguity = later;
  if (chosen.ambiguity.exists() && !accepts_ambiguous) chosen.refuse(Refusal::ambiguous);
}

Ambiguity ambiguity_of(const OtherPart& part, bool was_ambiguous, bool at_start) {
  const double factor = was_ambiguous ? kRepeatedOtherPart : 1, share = was_ambiguous ? kRepeatedShare : kRivalShare;
  const auto exceeds = [&](double area, double ratio) {
    return !part.is_rest && part.area > factor * area && part.ratio > factor * ratio;
  };
  const bool is_coherent = part.ratio > kCoherentRatio || part.balance > kPromisingBalance;
  const bool is_comparable = part.area > share * part.chosen_area;
  const bool is_large = exceeds(kOtherPartArea, kOtherPartRatio) && is_comparable && is_coherent;
  const bool surrounds = exceeds(kSurroundingArea, kSurroundingRatio) &&
                         (at_start ? part.spread > kStartSpread : part.spread > kSurroundingSpread && is_coherent);
  const double least_spread = was_ambiguous ? kRepeatedSpread : kSurroundingSpread;
  const bool prevails = part.agrees_globally && part.balance > factor && part.match_spread > least_spread;
  return is_large || surrounds || prevails ? Ambiguity{AmbiguityKind::other_part, part.area} : Ambiguity{};
}

TrackRecord::TrackRecord(const Config& config)
    : limits_(config.temporal), start_frames_(kRechecks), rechecks_(kRechecks) {}

void TrackRecord::remember(const MotionStep& found) {
  const bool was_certain = !was_ambiguous_ || doubtful_checks_ > 0;
  recent_support_ = found.ok() ? std::max(found.verdict.support, kSupportDecay * recent_support_) : 0;
  was_ambiguous_ = found.verdict.ambiguity.exists();
  --frames_to_check_;
  start_frames_ = found.ok() ? std::max(0, start_frames_ - 1) : kRechecks;
  if (!found.ok()) {
    frames_to_check_ = doubtful_checks_ = 0;
    rechecks_ = kRechecks;
  }
  if (!found.is_checked) return;
  doubtful_checks_ = found.shows_other_part && was_certain ? kRechecks : std::max(0, doubtful_checks_ - 1);
  const double moving_ratio = found.verdict.moving_ratio, before = std::exchange(checked_moving_ratio_, moving_ratio);
  const bool has_appeared = moving_ratio > std::max(kMinorityMotionRatio, before + kAppearanceStep);
  rechecks_ = was_ambiguous_ || has_appeared ? kRechecks : std::max(0, rechecks_ - 1);
  frames_to_check_ = rechecks_ > 0 ? 0 : kCheckInterval - 1;
}

void TrackRecord::remember_mask() {
  if (was_ambiguous_) doubtful_checks_ = kRechecks;
}

double TrackRecord::confident_support() const {
  if (limits_.global_edges == 0) return 0;
  if (rechecks_ > 0) return kConfidentSupport;
  return std::min(kConfidentSupport, std::max(kChanceSupport, kRecentSupportRatio * recent_support_));
}

Ambiguity TrackRecord::recent_other_part() const {
  return doubtful_checks_ > 0 ? Ambiguity{AmbiguityKind::recent_other_part, 0} : Ambiguity{};
}

bool TrackRecord::is_check_due(const Verdict& chosen) const {
  if (limits_.global_edges == 0) return false;
  const double noticeable = std::max(kCheckedMovingRatio, checked_moving_ratio_ + kMovingRatioStep);
  return frames_to_check_ <= 0 || chosen.moving_ratio > noticeable;
}

}  // namespace quadedge::odometry
