#include "motion/relocalisation.hpp"

namespace quadedge::motion {

Relocalisation::Relocalisation(frontend::Frontend& frontend, StepBuilder& steps, const Config& config)
    : frontend_(frontend),
      steps_(steps),
      limits_(limits_of_global_matches(config)),
      wide_edges_(config.temporal.wide_edges) {}

StepHandle Relocalisation::propose(const MotionQuery& query, const Evidence&) {
  StepHandle step = steps_.take(query.base);
  frontend_.match_globally(*query.base, wide_edges_, step->matches);
  steps_.propose(query, limits_, std::nullopt, *step);
  return step;
}

PoseConfig limits_of_global_matches(const Config& config) {
  PoseConfig limits = limits_of_proposals(config);
  limits.inlier_distance = config.temporal.wide_inlier_distance;
  return limits;
}

}  // namespace quadedge::motion
