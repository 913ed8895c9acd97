#include "motion/remaining_motion.hpp"

#include "motion/motion_constants.hpp"

namespace quadedge::motion {

RemainingMotion::RemainingMotion(StepBuilder& steps, const Config& config)
    : steps_(steps), limits_(limits_of_proposals(config)) {
  limits_.inlier_distance *= kCloseAgreement;
}

StepHandle RemainingMotion::propose(const MotionQuery& query, const Evidence& evidence) {
  if (evidence.confirmed == nullptr) return nullptr;
  const MotionStep& first = *evidence.confirmed;
  StepHandle step = steps_.take(first.base);
  for (std::size_t q = 0; q < first.quads.size(); ++q) {
    if (first.agrees[q] != 0) continue;
    const auto m = static_cast<std::size_t>(first.quads.match[q]);
    step->matches.append(first.matches.previous[m], first.matches.current[m], query.current->edges,
                         first.matches.ncc[m], first.matches.competing_clusters[m]);
  }
  steps_.propose(query, limits_, std::nullopt, *step);
  step->motion.current_from_previous = motion_since(query.base, query, *step);
  step->base = query.base;
  return step;
}

}  // namespace quadedge::motion
