#include "odometry/motion_search.hpp"

#include <utility>

#include "odometry/coarse_search.hpp"
#include "odometry/relocalisation.hpp"
#include "odometry/second_motion.hpp"

namespace quadedge::odometry {

MotionSearch::MotionSearch(const Config& config, frontend::Frontend& frontend, const DisparityOffset& offset)
    : steps_(config, offset), acceptance_(config, offset), confirmation_(config, frontend, steps_, acceptance_) {
  const auto add = [&](auto hypothesis) {
    hypotheses_.push_back(std::make_unique<decltype(hypothesis)>(std::move(hypothesis)));
  };
  add(CoarseSearch::near_prediction(frontend, steps_, config));
  if (config.temporal.wide_edges > 0) {
    add(Relocalisation(frontend, steps_, config));
    add(SecondMotion(steps_, config));
  } else {
    add(CoarseSearch::wide(frontend, steps_, config, offset.rig().left.width));
  }
}

StepHandle MotionSearch::find(const MotionQuery& query) {
  StepHandle found = search(query);
  acceptance_.remember(*found);
  return found;
}

StepHandle MotionSearch::search(const MotionQuery& query) {
  Evidence evidence;
  std::vector<Trial> trials;
  for (const auto& hypothesis : hypotheses_) {
    Trial trial = try_out(*hypothesis, query, evidence);
    if (!trial.proposed) continue;
    if (hypothesis->trusts_prediction() && acceptance_.is_confident(*trial.outcome()))
      return std::move(trial.outcome());
    trials.push_back(std::move(trial));
  }
  StepHandle found = std::move(best(trials).outcome());
  if (found->ok() && evidence.found_anywhere != nullptr &&
      !acceptance_.is_seen(*evidence.found_anywhere, query, *found))
    found->motion.status = pose::MotionStatus::no_consensus;
  return found;
}

MotionSearch::Trial MotionSearch::try_out(MotionHypothesis& hypothesis, const MotionQuery& query, Evidence& evidence) {
  Trial trial;
  trial.hypothesis = &hypothesis;
  trial.proposed = hypothesis.propose(query, evidence);
  if (trial.proposed && trial.proposed->ok())
    trial.confirmed = confirmation_.confirm(query, trial.proposed->motion.current_from_previous);
  return trial;
}

/// The trial whose motion explains most of the image. Between equals, two failures for instance, one that was made
/// without trust in the prediction wins, else the first.
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
