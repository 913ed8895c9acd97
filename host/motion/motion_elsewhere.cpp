#include "motion/motion_elsewhere.hpp"

#include <algorithm>

#include "motion/motion_constants.hpp"
#include "motion/relocalisation.hpp"

namespace quadedge::motion {

MotionElsewhere::MotionElsewhere(const Config& config, frontend::Frontend& frontend, StepBuilder& steps,
                                 Confirmation& confirmation, const Acceptance& acceptance)
    : config_(config),
      limits_(limits_of_global_matches(config)),
      frontend_(frontend),
      steps_(steps),
      confirmation_(confirmation),
      acceptance_(acceptance) {}

Elsewhere MotionElsewhere::find(const MotionQuery& query, const MotionStep& chosen, const MotionStep* global_matches,
                                bool thorough) {
  const int edges = config_.temporal.wide_edges / (thorough ? 1 : kElsewhereThinning);
  if (global_matches == nullptr) frontend_.match_globally(*query.base, std::max(1, edges), matches_);
  const TemporalMatches& all = global_matches != nullptr ? global_matches->matches : matches_;
  const StepHandle proposed = steps_.take(query.base);
  for (std::size_t m = 0; m < all.size(); ++m) {
    const ExplainedCell* cell = chosen.cells.at(all.left_x[m], all.left_y[m]);
    if (cell == nullptr || !cell->is_free()) continue;
    proposed->matches.append(all.previous[m], all.current[m], query.current->edges, all.ncc[m],
                             all.competing_clusters[m]);
  }
  steps_.propose(query, limits_, std::nullopt, *proposed);
  if (!proposed->ok()) return {};
  const StepHandle other = confirmation_.confirm_beside(query, proposed->motion.current_from_previous, chosen.cells);
  if (!other->ok()) return {};
  const ExplainedCells cells =
      acceptance_.explained_beside(*other, motion_since(query.base, query, chosen), config_.pose.inlier_distance);
  const int searched = chosen.cells.count(false), following = cells.count(true);
  const double count = following;
  Elsewhere found;
  found.area = count / std::max(1, searched + chosen.cells.count(true));
  found.ratio = count / std::max(1, searched);
  found.spread = cells.spread(true) / std::max(1e-9, chosen.cells.spread(false));
  return found;
}

}  // namespace quadedge::motion
