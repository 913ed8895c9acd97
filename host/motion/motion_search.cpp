#include "motion/motion_search.hpp"

#include <algorithm>
#include <utility>

#include "motion/coarse_search.hpp"
#include "motion/motion_constants.hpp"
#include "motion/relocalisation.hpp"
#include "motion/remaining_motion.hpp"
#include "motion/second_motion.hpp"
#include "motion/still_camera.hpp"

namespace quadedge::motion {

MotionSearch::MotionSearch(const Config& config, frontend::Frontend& frontend, const DisparityOffset& offset)
    : steps_(config, offset),
      acceptance_(config, offset),
      confirmation_(config, frontend, steps_, acceptance_),
      elsewhere_(config, frontend, steps_, confirmation_, acceptance_),
      record_(config) {
  const auto add = [&](auto hypothesis) {
    hypotheses_.push_back(std::make_unique<decltype(hypothesis)>(std::move(hypothesis)));
  };
  add(CoarseSearch::near_prediction(frontend, steps_, config));
  add(StillCamera(steps_));
  if (config.temporal.wide_edges > 0) {
    add(Relocalisation(frontend, steps_, config));
    add(SecondMotion(steps_, config));
  } else {
    add(CoarseSearch::wide(frontend, steps_, config, offset.rig().left.width));
  }
  add(RemainingMotion(steps_, config));
}

StepHandle MotionSearch::find(const MotionQuery& query) {
  Trials trials;
  Selection selection;
  Effort effort = Effort::prediction;
  for (;; effort = std::min(selection.needed, query.most)) {
    try_out(effort, query, trials);
    selection = choose(query, trials);
    if (std::min(selection.needed, query.most) <= effort) break;
  }
  if (trials.empty()) return nothing_tried(query);
  MotionStep& chosen = *trials.at(selection.trial).outcome();
  chosen.is_checked = selection.accepted && query.most == Effort::everything && record_.is_check_due(chosen.verdict);
  if (chosen.is_checked) {
    const Doubt beside = doubt_about(elsewhere_.find(query, chosen), record_.is_doubtful());
    if (!selection.doubt.exists()) selection.doubt = beside;
  }
  StepHandle found = std::move(trials.at(selection.trial).outcome());
  found->verdict = trials.at(selection.trial).verdict;
  found->doubt = selection.doubt;
  if (found->ok() && !selection.accepted) found->motion.status = pose::MotionStatus::no_consensus;
  return found;
}

/// The answer to a query that allows only the prediction and has none.
StepHandle MotionSearch::nothing_tried(const MotionQuery& query) {
  StepHandle step = steps_.take(query.base);
  step->motion = {};
  step->motion.status = pose::MotionStatus::no_consensus;
  return step;
}

void MotionSearch::try_out(Effort effort, const MotionQuery& query, Trials& trials) {
  for (const auto& hypothesis : hypotheses_) {
    const auto is_its = [&](const Trial& trial) { return trial.hypothesis == hypothesis.get(); };
    if (hypothesis->effort() > effort || std::any_of(trials.begin(), trials.end(), is_its)) continue;
    Trial trial{hypothesis.get(), hypothesis->propose(query, evidence_of(trials)), nullptr, {}};
    if (!trial.proposed) continue;
    if (trial.proposed->ok())
      trial.confirmed = confirmation_.confirm(query, trial.proposed->motion.current_from_previous,
                                              hypothesis->requires_close_agreement(), record_.confident_support(),
                                              known_motion(trials));
    trials.push_back(std::move(trial));
  }
}

const MotionStep* MotionSearch::known_motion(const Trials& trials) {
  for (const Trial& trial : trials)
    if (trial.is_confirmed() && !trial.hypothesis->requires_close_agreement()) return trial.confirmed.get();
  return nullptr;
}

Evidence MotionSearch::evidence_of(const Trials& trials) {
  Evidence evidence;
  for (const Trial& trial : trials) {
    if (evidence.confirmed == nullptr && trial.is_confirmed()) evidence.confirmed = trial.confirmed.get();
    if (trial.hypothesis->matches_globally()) evidence.global_matches = trial.proposed.get();
  }
  return evidence;
}

Selection MotionSearch::choose(const MotionQuery& query, Trials& trials) const {
  const Evidence evidence = evidence_of(trials);
  const double confident_support = query.most == Effort::prediction ? kChanceSupport : record_.confident_support();
  Expectation expectation{std::nullopt, record_.is_doubtful(), confident_support};
  std::vector<Verdict> verdicts;
  for (Trial& trial : trials) {
    if (trial.hypothesis->effort() == Effort::prediction) expectation.trial = verdicts.size();
    trial.verdict = verdict_of(trial, evidence, query);
    verdicts.push_back(trial.verdict);
  }
  Comparison comparison;
  comparison.is_same = [&](std::size_t one, std::size_t other) {
    const MotionStep &found = *trials[one].outcome(), &its = *trials[other].outcome();
    return acceptance_.is_same_motion(found, motion_since(found.base, query, its));
  };
  comparison.area_beside = [&](std::size_t one, std::size_t other) {
    const MotionStep &found = *trials[one].outcome(), &its = *trials[other].outcome();
    return acceptance_.area_beside(found, its, motion_since(found.base, query, its));
  };
  return select(verdicts, expectation, comparison);
}

Verdict MotionSearch::verdict_of(const Trial& trial, const Evidence& evidence, const MotionQuery& query) const {
  const MotionStep& step = trial.outcome();
  Verdict verdict = step.verdict;
  verdict.found = trial.is_confirmed();
  verdict.has_all_inliers = !trial.hypothesis->requires_close_agreement();
  if (verdict.found && evidence.global_matches != nullptr)
    verdict.agrees_globally =
        acceptance_.agrees_with_global_matches(*evidence.global_matches, query, step, verdict.global_ratio);
  return verdict;
}

}  // namespace quadedge::motion
