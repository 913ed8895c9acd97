#include "motion/coarse_search.hpp"

#include <algorithm>

#include "frontend/prediction.hpp"

namespace quadedge::motion {

CoarseSearch CoarseSearch::near_prediction(frontend::Frontend& frontend, StepBuilder& steps, const Config& config) {
  return {frontend, steps, config, config.temporal.coarse_radius, true};
}

CoarseSearch CoarseSearch::wide(frontend::Frontend& frontend, StepBuilder& steps, const Config& config,
                                int image_width) {
  return {frontend, steps, config, config.temporal.coarse_wide_radius_ratio * image_width, false};
}

CoarseSearch::CoarseSearch(frontend::Frontend& frontend, StepBuilder& steps, const Config& config, double radius,
                           bool trusts_prediction)
    : frontend_(frontend),
      steps_(steps),
      limits_(limits_of_proposals(config)),
      edges_(config.temporal.coarse_edges),
      radius_(radius),
      trusts_prediction_(trusts_prediction) {}

StepHandle CoarseSearch::propose(const MotionQuery& query, const Evidence&) {
  if (trusts_prediction_ && !query.prediction) return nullptr;
  const StereoEdges& edges = query.base->edges;
  const int every = std::max(1, (static_cast<int>(edges.size()) + edges_ - 1) / edges_);
  frontend::predict_positions(steps_.calibration(), edges, steps_.measured(*query.base), query.prediction, radius_,
                              every, search_);
  search_.coarse = true;
  StepHandle step = steps_.take(query.base);
  frontend_.match(*query.base, search_, step->matches);
  steps_.propose(query, limits_, query.prediction, *step);
  return step;
}

}  // namespace quadedge::motion
