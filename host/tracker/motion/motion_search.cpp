/// \file motion_search.cpp  Levels of hypotheses; guided matching repeats until the positions it predicts settle.
#include "motion/motion_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "edges/prediction.hpp"
#include "motion/odometry_constants.hpp"
#include "motion/repetition.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::odometry {
namespace {

/// Leaves an edge out.
void hide(std::size_t i, TemporalSearch& search) {
  search.left.x[i] = search.left.y[i] = search.right.x[i] = search.right.y[i] = std::numeric_limits<float>::quiet_NaN();
}

/// Leaves out the edges that are predicted where another motion explains the image.
void hide_explained(const ExplainedCells& other, TemporalSearch& search) {
  for (std::size_t i = 0; i < search.left.size(); ++i) {
    const ExplainedCell* cell = other.at(search.left.x[i], search.left.y[i]);
    if (cell == nullptr || !cell->is_free()) hide(i, search);
  }
}

/// Leaves out the edges that are predicted in masked pixels.
void hide_masked(const PixelMask& hidden, TemporalSearch& search) {
  if (hidden.empty()) return;
  for (std::size_t i = 0; i < search.left.size(); ++i) {
    const float x = search.left.x[i], y = search.left.y[i];
    if (!(x >= 0 && x < static_cast<float>(hidden.width) && y >= 0 && y < static_cast<float>(hidden.height))) continue;
    if (hidden.hidden[static_cast<std::size_t>(static_cast<int>(y) * hidden.width + static_cast<int>(x))] != 0)
      hide(i, search);
  }
}

}  // namespace

MotionSearch::MotionSearch(const Config& config, frontend::GlobalFrontend& frontend, const StereoRig& rig)
    : config_(config),
      frontend_(frontend),
      fits_(config, rig),
      proposals_(config, frontend, fits_),
      evidence_(config, rig),
      record_(config) {}

StepHandle MotionSearch::find(const MotionQuery& query) {
  if (StepHandle found = find_by_few_matches(query)) return found;
  State state(query);
  while (!advance(state)) {
  }
  return std::move(state.found);
}

/// A level up to the global matches, the rest of it, or the check.
bool MotionSearch::advance(State& state) {
  const MotionQuery& query = state.query;
  Candidates& candidates = state.candidates_;
  if (state.found) {
    check(query, state.found);
    return true;
  }
  while (state.next_ < std::size(kTrials)) {
    const Trial& trial = kTrials[state.next_++];
    const bool has_global = config_.temporal.global_edges > 0;
    if (trial.level > state.level_ || trial.with_global.value_or(has_global) != has_global) continue;
    if (trial.hypothesis == Hypothesis::near_prediction)
      try_prediction(state.query, candidates);
    else
      attempt(trial.hypothesis, query, candidates);
    if (trial.hypothesis == Hypothesis::global_matches) return false;
  }
  std::vector<Verdict> verdicts = verdicts_on(candidates, query);
  std::size_t chosen = verdicts.empty() ? 0 : choose(candidates, query, verdicts);
  if (!verdicts.empty() && use_support_of_base(query, candidates[chosen])) {
    verdicts = verdicts_on(candidates, query);
    chosen = choose(candidates, query, verdicts);
  }
  const SearchLevel needed = verdicts.empty() ? SearchLevel::everything : verdicts[chosen].needed;
  if (!query.only_near_prediction && needed > state.level_) {
    state.level_ = needed;
    state.next_ = 0;
  } else if (candidates.empty()) {  // only a motion near a prediction, and there is none
    state.found = fits_.new_step(query, query.base);
  } else {
    state.found = std::move(candidates[chosen].outcome());
    state.found->verdict = verdicts[chosen];
    candidates.clear();
  }
  if (!state.found || state.found->ok()) return false;
  check(query, state.found);
  return true;
}

/// At the start a few global matches take the place of the prediction if they leave no doubt; otherwise null, as though
/// they had not been tried.
StepHandle MotionSearch::find_by_few_matches(const MotionQuery& query) {
  if (!query.at_start) return nullptr;
  Candidates candidates;
  attempt(Hypothesis::few_global_matches, query, candidates);
  std::vector<Verdict> verdicts = verdicts_on(candidates, query);
  if (verdicts.empty()) return nullptr;
  choose(candidates, query, verdicts);
  if (verdicts.front().needed > SearchLevel::prediction) return nullptr;
  StepHandle found = std::move(candidates.front().outcome());
  found->verdict = verdicts.front();
  check(query, found);
  return found->verdict.ambiguity.exists() ? nullptr : std::move(found);
}

/// Completes the verdict on the motion chosen, which the rest of the image may contradict.
void MotionSearch::check(const MotionQuery& query, StepHandle& handle) {
  Ambiguity repeated;
  // Earlier keyframes, of which no prediction is known, are told apart by one another.
  const bool is_earlier = !query.prediction && !query.accepts_ambiguous,
             is_predicted = query.prediction && handle->verdict.is_predicted;
  if (handle->ok() && !is_earlier && !is_predicted) repeated = try_periods(query, handle);
  MotionStep& found = *handle;
  if (repeated.exists()) found.verdict.ambiguity = repeated;
  found.is_checked = found.ok() && !query.only_near_prediction && record_.is_check_due(found.verdict);
  Ambiguity other_part;
  if (found.is_checked) other_part = search_free_cells(query, found);
  if (found.is_checked && !other_part.exists()) other_part = search_still_edges(query, found);
  found.shows_other_part = other_part.exists();
  if (!other_part.exists() && query.accepts_ambiguous) other_part = record_.recent_other_part();
  decide(query.accepts_ambiguous, other_part, found.verdict);
}

/// Tries what differs from the chosen motion by a period of a scene that repeats. Unless edges that are not repeated
/// tell for the chosen motion, it is ambiguous; if they tell for another one, that takes its place.
Ambiguity MotionSearch::try_periods(const MotionQuery& query, StepHandle& found) {
  const pose::MeasuredEdges& measured = fits_.measured(*query.current, query);
  const StereoRig rig = fits_.calibration(query);
  const double period = period_along(rig.left, measured, *found);
  if (period == 0) return {};
  const Eigen::Isometry3d chosen = found->motion.learned.current_from_previous;
  const frontend::FrameEdgesHandle base = found->base;
  Ambiguity ambiguity;
  TemporalMatches matches;
  for (const double shift : {period, -period}) {
    Eigen::Isometry3d shifted = chosen;
    shifted.pretranslate(shift * chosen.translation().normalized());
    frontend::predict_positions(rig, base->edges, fits_.measured(*base, query), shifted, config_.temporal.radius, 1,
                                search_);
    frontend_.match(*base, *query.current, search_, matches);
    const SharedEdges shared = compare_shifted(rig.left, measured, {found->matches, chosen}, {matches, shifted});
    if (shared.tell_for_first()) continue;
    StepHandle other = shared.tell_for_second() ? confirm_with(base, query, config_.pose, shifted, {}) : nullptr;
    if (other && other->ok())
      std::swap(found, other);
    else
      ambiguity = {AmbiguityKind::repeated_scene, std::abs(period)};
  }
  return ambiguity;
}

/// Tries the prediction, unless that has been tried. If the matches near it show that the right image is displaced, it
/// is tried with the displacement as well, which the query keeps if so much more of the image is explained then.
void MotionSearch::try_prediction(MotionQuery& query, Candidates& candidates) {
  if (!candidates.empty()) return;
  Candidate plain{Hypothesis::near_prediction, proposals_.near_prediction(query), nullptr};
  if (!plain.proposed) return;
  Candidates displaced;
  MotionQuery with_jump = query;
  if (follow_displacement(*plain.proposed, with_jump)) attempt(Hypothesis::near_prediction, with_jump, displaced);
  const bool is_displaced = !displaced.empty() && displaced.front().is_confirmed();
  // What a motion without the displacement has to explain.
  const double needed = is_displaced ? displaced.front().confirmed->verdict.area / query.displacement.gain : 0;
  const auto confirmed = [&](const Eigen::Isometry3d& motion) {
    return confirm(query, motion, false, {nullptr, nullptr, kFirstRoundArea * needed});
  };
  const auto area = [](const StepHandle& step) { return step && step->ok() ? step->verdict.area : 0; };
  if (plain.proposed->ok()) plain.confirmed = confirmed(plain.proposed->motion.current_from_previous);
  if (area(plain.confirmed) < needed && query.displacement.gain > 1) {  // a second chance, from a better start
    StepHandle again = confirmed(motion_since(query.base, query, *displaced.front().confirmed));
    if (area(again) > area(plain.confirmed)) plain.confirmed = std::move(again);
  }
  if (area(plain.confirmed) < needed) {
    candidates = std::move(displaced);
    query = std::move(with_jump);
  } else {
    candidates.push_back(std::move(plain));
  }
}

/// Whether the matches near the prediction show that the right image is displaced, by what the query then contains.
bool MotionSearch::follow_displacement(const MotionStep& near_prediction, MotionQuery& query) {
  if (query.rig.displacement != 0) return false;
  const MotionStep& step = near_prediction;
  const auto jump =
      jump_meter_.measure(fits_.measured(*step.base, query), fits_.measured(*query.current, query), step.matches,
                          step.ok() ? step.motion.current_from_previous : *query.prediction);
  // The base is measured with its own displacement, the current frame without one.
  if (!jump || !jump->is_certain(query.displacement.least)) return false;
  query.rig.displacement = jump->shift;
  query.rig.displacement_sigma = std::hypot(jump->sigma, rig::kJumpSigma, step.base->rig().displacement_sigma);
  return true;
}

/// Whether it competes with a motion that differs by a pixel or two. With the usual inlier distance, a fit would
/// include the edges of both motions and end between them.
bool MotionSearch::is_close_to_another(Hypothesis hypothesis) {
  return hypothesis == Hypothesis::still_camera || hypothesis == Hypothesis::rest_of_confirmed;
}

/// Tries a hypothesis, unless that has been tried.
void MotionSearch::attempt(Hypothesis hypothesis, const MotionQuery& query, Candidates& candidates) {
  const MotionStep* known = nullptr;  // the first confirmed motion with all of its inliers
  for (const Candidate& candidate : candidates) {
    if (candidate.hypothesis == hypothesis) return;
    if (known == nullptr && candidate.is_confirmed() && !is_close_to_another(candidate.hypothesis))
      known = candidate.confirmed.get();
  }
  if (hypothesis == Hypothesis::still_camera && known != nullptr && !may_stand_still(query)) return;
  Candidate candidate{hypothesis, propose(hypothesis, query, candidates), nullptr};
  if (!candidate.proposed) return;
  if (candidate.proposed->ok()) {
    const bool closely = is_close_to_another(hypothesis);
    const double competing = closely && known != nullptr ? kHopelessAreaRatio * known->verdict.area : 0;
    candidate.confirmed =
        confirm(query, candidate.proposed->motion.current_from_previous, closely, {known, nullptr, competing});
  }
  candidates.push_back(std::move(candidate));
}

/// A motion since the query's base, or null if there is nothing to try.
StepHandle MotionSearch::propose(Hypothesis hypothesis, const MotionQuery& query, const Candidates& candidates) {
  const auto first = [&](auto is_wanted) { return std::find_if(candidates.begin(), candidates.end(), is_wanted); };
  switch (hypothesis) {
    case Hypothesis::near_prediction: return proposals_.near_prediction(query);
    case Hypothesis::large_radius: return proposals_.in_large_radius(query);
    case Hypothesis::few_global_matches: return proposals_.few_global_matches(query);
    case Hypothesis::still_camera: return proposals_.still_camera(query);
    case Hypothesis::global_matches: return proposals_.global_matches(query);
    case Hypothesis::rest_of_global_matches:
      return proposals_.rest_of_global_matches(
          query, *first([](const Candidate& of) { return of.hypothesis == Hypothesis::global_matches; })->proposed);
    case Hypothesis::rest_of_confirmed: {
      const auto confirmed = first([](const Candidate& candidate) { return candidate.is_confirmed(); });
      return confirmed == candidates.end() ? nullptr : proposals_.rest_of_confirmed(query, *confirmed->confirmed);
    }
  }
  return nullptr;
}

/// The motion since the keyframe or, if that is not confirmed, since the base; null if the proposal leads to `known`.
/// \param closely whether inliers have to lie within a third of the usual distance
StepHandle MotionSearch::confirm(const MotionQuery& query, const Eigen::Isometry3d& current_from_base, bool closely,
                                 const Others& others) {
  PoseConfig limits = config_.pose;
  if (closely) limits.inlier_distance *= kCloseAgreement;
  if (query.key) {
    StepHandle step = confirm_with(query.key, query, limits, current_from_base * query.base_from_key, others);
    if (!step || step->ok()) return step;
  }
  return confirm_with(query.base, query, limits, current_from_base, others);
}

/// Few edges match a keyframe that is moving out of view. If the edges of the base, which is closer in time, follow the
/// same motion, their support is used. \returns whether it is larger
bool MotionSearch::use_support_of_base(const MotionQuery& query, Candidate& by_key) {
  if (!query.key || !by_key.is_confirmed() || is_close_to_another(by_key.hypothesis)) return false;
  MotionStep& step = *by_key.confirmed;
  if (step.base != query.key || step.verdict.support >= record_.confident_support() ||
      std::exchange(by_key.has_support_of_base, true))
    return false;
  const Eigen::Isometry3d current_from_base = motion_since(query.base, query, step);
  const StepHandle by_base = confirm_with(query.base, query, config_.pose, current_from_base, {});
  if (!by_base->ok() || by_base->verdict.support <= step.verdict.support) return false;
  if (!evidence_.is_same_motion(*by_base, current_from_base)) return false;
  step.verdict.support = by_base->verdict.support;
  return true;
}

/// Matches some of the base's edges, evenly chosen, around where they were.
StepHandle MotionSearch::match_at_rest(const MotionQuery& query) {
  PoseConfig limits = config_.pose;
  limits.min_hypotheses = 0;
  limits.inlier_distance *= kCloseAgreement;
  const Eigen::Isometry3d still = Eigen::Isometry3d::Identity();
  frontend::predict_positions(fits_.calibration(query), query.base->edges, fits_.measured(*query.base, query), still,
                              config_.temporal.radius, kStillStep, search_);
  hide_masked(hidden_, search_);
  StepHandle step = fits_.new_step(query, query.base);
  frontend_.match(*query.base, *query.current, search_, step->matches);
  fits_.fit(query, limits, still, pose::RefinementGoal::pose, *step);
  return step;
}

/// Whether these support a motion near standstill at all.
bool MotionSearch::may_stand_still(const MotionQuery& query) {
  const StepHandle step = match_at_rest(query);
  evidence_.judge(search_.left, kStillSupport * config_.temporal.min_support, *step);
  return step->ok();
}

/// Matches all edges of a frame within a few pixels of the positions that a motion predicts, and repeats this with the
/// motion found until the predicted positions no longer change.
StepHandle MotionSearch::confirm_with(const frontend::FrameEdgesHandle& base, const MotionQuery& query,
                                      PoseConfig limits, Eigen::Isometry3d current_from_base, const Others& others) {
  // The proposal has drawn hypotheses and is near; more are drawn only as its inlier ratio requires.
  limits.min_hypotheses = limits.local_optimisation_rounds = 0;
  const auto predict = [&](const Eigen::Isometry3d& motion, int every, TemporalSearch& search) {
    frontend::predict_positions(fits_.calibration(query), base->edges, fits_.measured(*base, query), motion,
                                config_.temporal.radius, every, search);
    hide_masked(hidden_, search);
    if (query.current->hidden) hide_masked(*query.current->hidden, search);
  };
  const auto predict_all = [&] {
    predict(current_from_base, 1, search_);
    if (others.explained != nullptr) hide_explained(*others.explained, search_);
  };
  const MotionStep* const known = others.known;
  if (known != nullptr) predict(motion_since(base, query, *known), kSettledStep, known_search_);
  const auto shift_from_known = [&] {
    return frontend::mean_distance(known_search_.left, next_search_.left, kSettledStep);
  };
  StepHandle step = fits_.new_step(query, base);
  if (known != nullptr && known->base == base) {
    predict(current_from_base, kSettledStep, next_search_);
    if (shift_from_known() < kNearKnown) {
      step->matches = known->matches;
      fits_.fit(query, limits, current_from_base, pose::RefinementGoal::pose, *step);
      predict(step->motion.current_from_previous, kSettledStep, next_search_);
      if (step->ok() && shift_from_known() < kSettled) return nullptr;
    }
  }
  predict_all();
  for (int round = 1;; ++round) {
    frontend_.match(*base, *query.current, search_, step->matches);
    fits_.fit(query, limits, current_from_base, pose::RefinementGoal::pose_and_covariance, *step);
    evidence_.judge(search_.left, others.explained != nullptr ? 0 : config_.temporal.min_support, *step);
    if (!step->ok()) break;
    current_from_base = step->motion.current_from_previous;
    predict(current_from_base, kSettledStep, next_search_);
    if (known != nullptr && shift_from_known() < kSettled) return nullptr;
    if (round == kGuidedRounds || step->verdict.area < others.least_area ||
        frontend::mean_distance(search_.left, next_search_.left, kSettledStep) < kSettled)
      break;
    predict_all();
  }
  return step;
}

std::vector<Verdict> MotionSearch::verdicts_on(const Candidates& candidates, const MotionQuery& query) const {
  const auto proposed = [&](Hypothesis hypothesis) -> const MotionStep* {
    for (const Candidate& candidate : candidates)
      if (candidate.hypothesis == hypothesis) return candidate.proposed.get();
    return nullptr;
  };
  const MotionStep *global = proposed(Hypothesis::global_matches), *rest = proposed(Hypothesis::rest_of_global_matches);
  std::vector<Verdict> verdicts;
  for (const Candidate& candidate : candidates) {
    const MotionStep& step = candidate.outcome();
    Verdict verdict = step.verdict;
    if (!candidate.confirmed) verdict.refuse(Refusal::duplicate);
    verdict.has_all_inliers = !is_close_to_another(candidate.hypothesis);
    if (verdict.is_confirmed() && global != nullptr)
      evidence_.compare_globally(*global, rest, motion_since(query.base, query, step), verdict);
    verdicts.push_back(verdict);
  }
  return verdicts;
}

std::size_t MotionSearch::choose(const Candidates& candidates, const MotionQuery& query,
                                 std::vector<Verdict>& verdicts) const {
  Expectation expectation;
  expectation.was_ambiguous = record_.was_ambiguous();
  expectation.confident_support = query.only_near_prediction ? kChanceSupport : record_.confident_support();
  const Hypothesis first = candidates.front().hypothesis;
  if (first == Hypothesis::near_prediction || first == Hypothesis::few_global_matches) expectation.predicted = 0;
  Comparison comparison;
  comparison.is_same = [&](std::size_t one, std::size_t other) {
    const MotionStep &found = candidates[one].outcome(), &its = candidates[other].outcome();
    return evidence_.is_same_motion(found, motion_since(found.base, query, its));
  };
  comparison.area_beside = [&](std::size_t one, std::size_t other) {
    const MotionStep &found = candidates[one].outcome(), &its = candidates[other].outcome();
    return evidence_.area_beside(found, its, motion_since(found.base, query, its));
  };
  comparison.is_repeated = [&](std::size_t one, std::size_t other) {
    const MotionStep &expected = candidates[one].outcome(), &its = candidates[other].outcome();
    const PinholeCamera camera = fits_.calibration(query).left;
    const pose::MeasuredEdges& measured = fits_.measured(*query.current, query);
    const Eigen::Isometry3d motion = motion_since(its.base, query, expected);
    const double period = period_along(camera, measured, its);
    if (period == 0 || !differs_by_periods(its, motion, period)) return false;
    return !compare_shifted(camera, measured, {expected.matches, motion},
                            {its.matches, its.motion.current_from_previous})
                .tell_for_second();
  };
  return select(verdicts, expectation, comparison);
}

/// An object that fills much of the image may hold most of the edges, so that its motion is chosen with confidence. The
/// scene beside it moves too far to be found near that motion, and is searched for where that explains nothing. If the
/// matches there lead to the chosen motion again, or to none of the scene's, the rest of them is tried.
Ambiguity MotionSearch::search_free_cells(const MotionQuery& query, const MotionStep& chosen) {
  const StepHandle matches = proposals_.in_free_cells(query, chosen);
  if (!matches->ok()) return {};
  const OtherPart part = compare_in_free_cells(query, chosen, *matches, *matches);
  const Ambiguity ambiguity = ambiguity_of(part, record_.was_ambiguous(), record_.at_start());
  if (ambiguity.exists()) return ambiguity;
  const StepHandle rest = proposals_.rest_of_global_matches(query, *matches);
  if (!rest->ok()) return {};
  OtherPart promised;  // the guided search takes longer than the rest of this
  evidence_.compare_globally(*matches, rest->motion.current_from_previous, chosen,
                             motion_since(query.base, query, chosen), promised);
  if (promised.balance < kPromisingBalance) return {};
  OtherPart other = compare_in_free_cells(query, chosen, *matches, *rest);
  other.is_rest = true;
  return ambiguity_of(other, record_.was_ambiguous());
}

/// Edges that stand still among those of an object that fills most of the image may be all that shows the scene.
Ambiguity MotionSearch::search_still_edges(const MotionQuery& query, const MotionStep& chosen) {
  const StepHandle still = match_at_rest(query);
  const double ratio = evidence_.still_beside(*still, motion_since(query.base, query, chosen));
  return ratio > kStillAround ? Ambiguity{AmbiguityKind::static_scene, ratio} : Ambiguity{};
}

OtherPart MotionSearch::compare_in_free_cells(const MotionQuery& query, const MotionStep& chosen,
                                              const MotionStep& matches, const MotionStep& proposed) {
  OtherPart part;
  const StepHandle other = confirm_with(query.base, query, limits_of_proposals(config_),
                                        proposed.motion.current_from_previous, {nullptr, &chosen.cells, 0});
  if (!other->ok()) return part;
  const Eigen::Isometry3d by_chosen = motion_since(query.base, query, chosen);
  const ExplainedCells cells = evidence_.explained_beside(*other, by_chosen, config_.pose.inlier_distance);
  const double searched = chosen.cells.count(false), followed = chosen.cells.count(true), count = cells.count(true);
  part.area = count / std::max(1.0, searched + followed);
  part.chosen_area = followed / std::max(1.0, searched + followed);
  part.ratio = count / std::max(1.0, searched);
  part.spread = (cells.spreads(true) / chosen.cells.spreads().max(1e-9)).minCoeff();
  evidence_.compare_globally(matches, other->motion.current_from_previous, chosen, by_chosen, part);
  if (!chosen.verdict.is_predicted || !ambiguity_of(part, false, record_.at_start()).exists()) return part;
  const double period = period_along(fits_.calibration(query).left, fits_.measured(*query.current, query), chosen);
  const Eigen::Isometry3d motion = motion_since(chosen.base, query, *other);
  return period != 0 && differs_by_periods(chosen, motion, period) ? OtherPart() : part;
}

}  // namespace quadedge::odometry
