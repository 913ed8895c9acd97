#include "motion/motion_selection.hpp"

#include <cmath>

#include "motion/motion_constants.hpp"

namespace quadedge::motion {
namespace {

/// The motion that explains the largest area. Of equal trials, such as two failures, one that does not rely on the
/// prediction takes precedence, then the first.
std::size_t largest(const std::vector<Verdict>& verdicts, const std::optional<std::size_t>& predicted) {
  const auto beats = [&](std::size_t one, std::size_t other) {
    const Verdict &its = verdicts[one], &others = verdicts[other];
    if (its.found != others.found) return its.found;
    if (its.found && its.explained_area != others.explained_area) return its.explained_area > others.explained_area;
    return predicted == other;
  };
  std::size_t best = 0;
  for (std::size_t trial = 1; trial < verdicts.size(); ++trial)
    if (beats(trial, best)) best = trial;
  return best;
}

/// The same motion with all of its inliers, if another trial led to it.
std::size_t with_all_inliers(std::size_t chosen, const std::vector<Verdict>& verdicts, const Comparison& comparison) {
  if (!verdicts[chosen].found || verdicts[chosen].has_all_inliers) return chosen;
  for (std::size_t other = 0; other < verdicts.size(); ++other)
    if (verdicts[other].found && verdicts[other].has_all_inliers && comparison.is_same(chosen, other)) return other;
  return chosen;
}

/// The largest area that a different motion explains and the chosen one does not, in units of the chosen motion's; 0 if
/// none competes.
double competing_area(std::size_t chosen, const std::vector<Verdict>& verdicts, const Comparison& comparison) {
  const double unit = verdicts[chosen].explained_area;
  double largest = 0;
  for (std::size_t other = 0; other < verdicts.size(); ++other) {
    if (other == chosen || !verdicts[other].found) continue;
    const auto competes = [&](double area) { return area >= kCompetingAreaRatio * unit && area >= largest * unit; };
    if (!competes(verdicts[other].explained_area) || comparison.is_same(chosen, other)) continue;
    const double area = comparison.area_beside(other, chosen);
    if (competes(area)) largest = unit > 0 ? area / unit : 1;
  }
  return largest;
}

Doubt doubt_about(std::size_t chosen, const std::vector<Verdict>& verdicts, const Comparison& comparison) {
  const Verdict& verdict = verdicts[chosen];
  if (verdict.moving_ratio > kMinorityMotionRatio && verdict.global_ratio < kConfirmedGlobalRatio)
    return {Ambiguity::moving_image, verdict.moving_ratio};
  if (verdict.static_ratio > kStaticQuadRatio) return {Ambiguity::static_scene, verdict.static_ratio};
  const double area = competing_area(chosen, verdicts, comparison);
  return area > 0 ? Doubt{Ambiguity::competing_motion, area} : Doubt{};
}

/// A confident prediction that explains the image ends the search. If a part of the image moves differently, the
/// inexpensive hypotheses are tried as well; if most of it does, if the prediction is doubtful, or if one of them
/// explains more, everything.
Effort effort_for(const Verdict& chosen, bool is_expected, bool is_doubtful) {
  if (is_doubtful || !is_expected || chosen.moving_ratio > kMinorityMotionRatio) return Effort::everything;
  const bool in_doubt = chosen.moving_ratio > kSecondaryMotionRatio || chosen.static_ratio > kStaticQuadRatio;
  return in_doubt ? Effort::inexpensive : Effort::prediction;
}

/// A ratio as a percentage.
std::string percent(double ratio) { return std::to_string(std::lround(100 * ratio)) + " %"; }

}  // namespace

std::string to_string(const Doubt& doubt) {
  switch (doubt.kind) {
    case Ambiguity::none: return "";
    case Ambiguity::moving_image: return percent(doubt.ratio) + " of the image move differently";
    case Ambiguity::static_scene:
      return percent(doubt.ratio) + " of the edges are where they were, although the motion would have moved them";
    case Ambiguity::competing_motion:
      return "another motion explains " + percent(doubt.ratio) + " of the area that this one explains";
    case Ambiguity::motion_elsewhere:
      return percent(doubt.ratio) + " of the image follow another motion and not this one";
  }
  return "";
}

Selection select(const std::vector<Verdict>& verdicts, const Expectation& expectation, const Comparison& comparison) {
  Selection selection;
  if (verdicts.empty()) return selection;
  selection.trial = with_all_inliers(largest(verdicts, expectation.trial), verdicts, comparison);
  const Verdict& chosen = verdicts[selection.trial];
  const bool is_expected =
      chosen.found && selection.trial == expectation.trial && chosen.support >= expectation.confident_support;
  selection.needed = effort_for(chosen, is_expected, expectation.is_doubtful);
  selection.accepted = chosen.found && (is_expected || chosen.agrees_globally);
  if (chosen.found) selection.doubt = doubt_about(selection.trial, verdicts, comparison);
  return selection;
}

Doubt doubt_about(const Elsewhere& elsewhere, bool is_doubtful) {
  const double factor = is_doubtful ? kDoubtfulElsewhere : 1;
  const auto exceeds = [&](double area, double ratio) {
    return elsewhere.area > factor * area && elsewhere.ratio > factor * ratio;
  };
  const bool is_large = exceeds(kElsewhereArea, kElsewhereRatio);
  const bool surrounds =
      exceeds(kSurroundingArea, kSurroundingRatio) && (is_doubtful || elsewhere.spread > kSurroundingSpread);
  return is_large || surrounds ? Doubt{Ambiguity::motion_elsewhere, elsewhere.area} : Doubt{};
}

}  // namespace quadedge::motion
