#include "odometry/motion_search.hpp"

#include <utility>

#include "odometry/coarse_search.hpp"
#include "odometry/relocalisation.hpp"
#include "odometry/remaining_motion.hpp"
#include "odometry/second_motion.hpp"
#include "odometry/still_camera.hpp"

namespace quadedge::odometry {

MotionSearch::MotionSearch(const Config& config, frontend::Frontend& frontend, const DisparityOffset& offset)
    : steps_(config, offset), acceptance_(config, offset), confirmation_(config, frontend, steps_, acceptance_) {
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

void MotionSearch::remember(const MotionStep& found) {
  acceptance_.remember(found);
  in_doubt_ = found.ambiguous;
}

StepHandle MotionSearch::find(const MotionQuery& query) {
  Evidence evidence;
  std::vector<Trial> trials;
  trials.reserve(hypotheses_.size());
  const auto try_hypothesis = [&](MotionHypothesis& hypothesis) {
    Trial trial = try_out(hypothesis, query, evidence);
    if (!trial.proposed) return;
    const MotionStep& outcome = *trial.outcome();
    if (evidence.confirmed == nullptr && trial.confirmed && outcome.ok()) evidence.confirmed = &outcome;
    trials.push_back(std::move(trial));
  };
  const auto choose = [&]() -> Trial& { return with_all_inliers(best(trials), trials, query); };
  const auto is_expected = [&](Trial& trial) {
    return trial.hypothesis->trusts_prediction() && acceptance_.is_confident(*trial.outcome());
  };
  const auto prediction_holds = [&](Trial& trial) {
    return !in_doubt_ && is_expected(trial) && !Acceptance::is_minority_motion(*trial.outcome());
  };
  const auto leaves_doubt = [&](const MotionStep& step) {
    return Acceptance::has_secondary_motion(step) || acceptance_.contradicts_static_scene(step);
  };
  for (const auto& hypothesis : hypotheses_) {
    // If a part of the image moves differently than predicted, the inexpensive hypotheses are tried as well; if most of
    // it does, all of them.
    if (hypothesis->is_costly() && !trials.empty() && prediction_holds(trials.front())) continue;
    try_hypothesis(*hypothesis);
    if (trials.size() == 1 && !in_doubt_ && is_expected(trials.front()) && !leaves_doubt(*trials.front().outcome()))
      return std::move(trials.front().outcome());
  }
  if (prediction_holds(trials.front()) && !is_expected(choose()))
    for (const auto& hypothesis : hypotheses_)
      if (hypothesis->is_costly()) try_hypothesis(*hypothesis);
  Trial& chosen = choose();
  const bool is_ambiguous = Acceptance::is_minority_motion(*chosen.outcome()) ||
                            acceptance_.contradicts_static_scene(*chosen.outcome()) ||
                            has_competing_motion(chosen, trials, query);
  StepHandle found = std::move(chosen.outcome());
  found->ambiguous = is_ambiguous;
  const bool was_expected = chosen.hypothesis->trusts_prediction() && acceptance_.is_confident(*found);
  if (found->ok() && !was_expected && evidence.global_matches != nullptr &&
      !acceptance_.agrees_with_global_matches(*evidence.global_matches, query, *found))
    found->motion.status = pose::MotionStatus::no_consensus;
  return found;
}

MotionSearch::Trial MotionSearch::try_out(MotionHypothesis& hypothesis, const MotionQuery& query, Evidence& evidence) {
  Trial trial;
  trial.hypothesis = &hypothesis;
  trial.proposed = hypothesis.propose(query, evidence);
  if (trial.proposed && trial.proposed->ok())
    trial.confirmed = confirmation_.confirm(query, trial.proposed->motion.current_from_previous,
                                            hypothesis.requires_close_agreement());
  return trial;
}

Eigen::Isometry3d MotionSearch::base_from_base(const MotionStep& found, const MotionStep& other,
                                               const MotionQuery& query) {
  const auto from_key = [&](const MotionStep& step) -> Eigen::Isometry3d {
    return query.key && step.base == query.base ? query.base_from_key : Eigen::Isometry3d::Identity();
  };
  return from_key(found) * from_key(other).inverse();
}

/// A motion that was confirmed with close agreement uses fewer quads than are available. If another trial found the
/// same motion with all its inliers, that trial is returned.
MotionSearch::Trial& MotionSearch::with_all_inliers(Trial& chosen, std::vector<Trial>& trials,
                                                    const MotionQuery& query) {
  const MotionStep& found = *chosen.outcome();
  if (!chosen.hypothesis->requires_close_agreement() || !found.ok()) return chosen;
  for (Trial& trial : trials) {
    const MotionStep& other = *trial.outcome();
    if (trial.hypothesis->requires_close_agreement() || !trial.confirmed || !other.ok()) continue;
    if (acceptance_.are_same_motion(found, other, base_from_base(found, other, query))) return trial;
  }
  return chosen;
}

bool MotionSearch::has_competing_motion(Trial& chosen, std::vector<Trial>& trials, const MotionQuery& query) {
  const MotionStep& found = *chosen.outcome();
  for (Trial& trial : trials) {
    const MotionStep& other = *trial.outcome();
    if (&trial == &chosen || !trial.confirmed) continue;
    if (acceptance_.are_competing(found, other, base_from_base(found, other, query))) return true;
  }
  return false;
}

/// The trial whose motion explains the largest image area. Between equal trials, such as two failures, one that does
/// not rely on the prediction takes precedence, then the first.
MotionSearch::Trial& MotionSearch::best(std::vector<Trial>& trials) {
  const auto beats = [](Trial& one, Trial& other) {
    const MotionStep &its = *one.outcome(), &others = *other.outcome();
    if (its.ok() != others.ok()) return its.ok();
    if (its.ok() && its.explained_area != others.explained_area) return its.explained_area > others.explained_area;
    return other.hypothesis->trusts_prediction() && !one.hypothesis->trusts_prediction();
  };
  Trial* best = &trials.at(0);
  for (Trial& trial : trials)
    if (beats(trial, *best)) best = &trial;
  return *best;
}

}  // namespace quadedge::odometry
