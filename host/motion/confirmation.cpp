#include "motion/confirmation.hpp"

#include <algorithm>
#include <limits>

#include "frontend/prediction.hpp"
#include "motion/motion_constants.hpp"

namespace quadedge::motion {
namespace {

/// Leaves out the edges that are predicted where another motion explains the image.
void hide_explained(const ExplainedCells& other, TemporalSearch& search) {
  constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < search.left.size(); ++i) {
    const ExplainedCell* cell = other.at(search.left.x[i], search.left.y[i]);
    if (cell != nullptr && cell->is_free()) continue;
    search.left.x[i] = search.left.y[i] = search.right.x[i] = search.right.y[i] = kNowhere;
  }
}

/// Whether a motion explains so little beside a confirmed one that further rounds would not make them ambiguous.
bool cannot_compete(const MotionStep& step, const MotionStep* known) {
  return known != nullptr && step.verdict.explained_area < kHopelessAreaRatio * known->verdict.explained_area;
}

}  // namespace

StepHandle Confirmation::confirm(const MotionQuery& query, const Eigen::Isometry3d& current_from_base, bool closely,
                                 double confident_support, const MotionStep* known) {
  PoseConfig limits = config_.pose;
  limits.min_hypotheses = 0;  // the proposal has drawn them; more are drawn only as its inlier ratio requires
  if (closely) limits.inlier_distance *= kCloseAgreement;
  const Others others{known, nullptr, closely};
  if (query.key) {
    StepHandle step = match(query, query.key, limits, current_from_base * query.base_from_key, others);
    if (step && step->ok() && !closely && step->verdict.support < confident_support)
      take_support_of_base(query, limits, *step);
    if (!step || step->ok()) return step;
  }
  return match(query, query.base, limits, current_from_base, others);
}

StepHandle Confirmation::confirm_beside(const MotionQuery& query, const Eigen::Isometry3d& current_from_base,
                                        const ExplainedCells& other) {
  PoseConfig limits = limits_of_proposals(config_);
  limits.min_hypotheses = 0;
  return match(query, query.base, limits, current_from_base, {nullptr, &other, false});
}

/// Few edges match a key rig that is moving out of view. If the edges of the base, which is closer in time, follow the
/// same motion, their support is used.
void Confirmation::take_support_of_base(const MotionQuery& query, const PoseConfig& limits, MotionStep& by_key) {
  const Eigen::Isometry3d current_from_base = motion_since(query.base, query, by_key);
  const StepHandle by_base = match(query, query.base, limits, current_from_base, {});
  if (by_base->ok() && acceptance_.is_same_motion(*by_base, current_from_base))
    by_key.verdict.support = std::max(by_key.verdict.support, by_base->verdict.support);
}

StepHandle Confirmation::match(const MotionQuery& query, const frontend::RigHandle& base, const PoseConfig& limits,
                               Eigen::Isometry3d current_from_base, const Others& others) {
  const auto predict = [&](const Eigen::Isometry3d& motion, int every, TemporalSearch& search) {
    frontend::predict_positions(steps_.calibration(), base->edges, steps_.measured(*base), motion,
                                config_.temporal.radius, every, search);
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
  StepHandle step = steps_.take(base);
  if (known != nullptr && known->base == base) {
    predict(current_from_base, kSettledStep, next_search_);
    if (shift_from_known() < kNearKnown) {
      step->matches = known->matches;
      steps_.propose(query, limits, current_from_base, *step);
      predict(step->motion.current_from_previous, kSettledStep, next_search_);
      if (step->ok() && shift_from_known() < kSettled) return nullptr;
    }
  }
  predict_all();
  for (int round = 1;; ++round) {
    frontend_.match(*base, search_, step->matches);
    steps_.estimate(query, limits, current_from_base, *step);
    acceptance_.test_support(search_.left, *step);
    if (!step->ok()) return step;
    current_from_base = step->motion.current_from_previous;
    predict(current_from_base, kSettledStep, next_search_);
    if (known != nullptr && shift_from_known() < kSettled) return nullptr;
    acceptance_.judge(search_.left, *step);
    if (round == config_.temporal.rounds || (others.must_compete && cannot_compete(*step, known)) ||
        frontend::mean_distance(search_.left, next_search_.left, kSettledStep) < kSettled)
      return step;
    predict_all();
  }
}

}  // namespace quadedge::motion
