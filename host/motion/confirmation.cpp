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

}  // namespace

StepHandle Confirmation::confirm(const MotionQuery& query, const Eigen::Isometry3d& current_from_base, bool closely,
                                 double confident_support) {
  PoseConfig limits = config_.pose;
  limits.min_hypotheses = 0;  // the proposal has drawn them; more are drawn only as its inlier ratio requires
  if (closely) limits.inlier_distance *= kCloseAgreement;
  if (query.key) {
    StepHandle step = match(query, query.key, limits, current_from_base * query.base_from_key);
    if (step->ok() && !closely && step->verdict.support < confident_support) take_support_of_base(query, limits, *step);
    if (step->ok()) return step;
  }
  return match(query, query.base, limits, current_from_base);
}

StepHandle Confirmation::confirm_beside(const MotionQuery& query, const Eigen::Isometry3d& current_from_base,
                                        const ExplainedCells& other) {
  PoseConfig limits = limits_of_proposals(config_);
  limits.min_hypotheses = 0;
  return match(query, query.base, limits, current_from_base, &other);
}

/// Few edges match a key rig that is moving out of view. If the edges of the base, which is closer in time, follow the
/// same motion, their support is used.
void Confirmation::take_support_of_base(const MotionQuery& query, const PoseConfig& limits, MotionStep& by_key) {
  const Eigen::Isometry3d current_from_base = motion_since(query.base, query, by_key);
  const StepHandle by_base = match(query, query.base, limits, current_from_base);
  if (by_base->ok() && acceptance_.is_same_motion(*by_base, current_from_base))
    by_key.verdict.support = std::max(by_key.verdict.support, by_base->verdict.support);
}

StepHandle Confirmation::match(const MotionQuery& query, const frontend::RigHandle& base, const PoseConfig& limits,
                               Eigen::Isometry3d current_from_base, const ExplainedCells* other) {
  const auto predict = [&](int every, TemporalSearch& search) {
    frontend::predict_positions(steps_.calibration(), base->edges, steps_.measured(*base), current_from_base,
                                config_.temporal.radius, every, search);
    if (other != nullptr) hide_explained(*other, search);
  };
  predict(1, search_);
  StepHandle step = steps_.take(base);
  for (int round = 1;; ++round) {
    frontend_.match(*base, search_, step->matches);
    steps_.estimate(query, limits, current_from_base, *step);
    acceptance_.test_support(search_.left, *step);
    if (!step->ok() || round == config_.temporal.rounds) break;
    current_from_base = step->motion.current_from_previous;
    predict(kSettledStep, next_search_);
    if (frontend::mean_distance(search_.left, next_search_.left, kSettledStep) < kSettled) break;
    predict(1, search_);
  }
  if (step->ok()) acceptance_.judge(search_.left, *step);
  return step;
}

}  // namespace quadedge::motion
