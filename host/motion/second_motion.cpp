#include "motion/second_motion.hpp"

#include "motion/relocalisation.hpp"

namespace quadedge::motion {

SecondMotion::SecondMotion(StepBuilder& steps, const Config& config)
    : steps_(steps), limits_(limits_of_global_matches(config)) {}

StepHandle SecondMotion::propose(const MotionQuery& query, const Evidence& evidence) {
  if (evidence.global_matches == nullptr || !evidence.global_matches->ok()) return nullptr;
  const MotionStep& first = *evidence.global_matches;
  explained_.assign(first.matches.size(), 0);
  for (std::size_t q = 0; q < first.quads.size(); ++q)
    explained_[static_cast<std::size_t>(first.quads.match[q])] = first.motion.inlier[q];
  StepHandle step = steps_.take(query.base);
  for (std::size_t m = 0; m < first.matches.size(); ++m) {
    if (explained_[m] != 0) continue;
    step->matches.append(first.matches.previous[m], first.matches.current[m], query.current->edges,
                         first.matches.ncc[m], first.matches.competing_clusters[m]);
  }
  steps_.propose(query, limits_, std::nullopt, *step);
  return step;
}

}  // namespace quadedge::motion
