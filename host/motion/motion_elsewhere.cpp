#include "motion/motion_elsewhere.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "frontend/prediction.hpp"
#include "motion/motion_constants.hpp"
#include "motion/relocalisation.hpp"

namespace quadedge::motion {
namespace {

/// Collects the indices of the positions that lie in free cells; if there are at least twice `wanted`, only every n-th,
/// so that at least `wanted` and fewer than twice `wanted` remain.
void take_free(const ExplainedCells& cells, const std::vector<float>& x, const std::vector<float>& y, int wanted,
               std::vector<std::int32_t>& numbers) {
  numbers.clear();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const ExplainedCell* cell = cells.at(x[i], y[i]);
    if (cell != nullptr && cell->is_free()) numbers.push_back(static_cast<std::int32_t>(i));
  }
  const auto step = static_cast<std::size_t>(wide_step(numbers.size(), wanted));
  std::size_t kept = 0;
  for (std::size_t k = 0; k < numbers.size(); k += step) numbers[kept++] = numbers[k];
  numbers.resize(kept);
}

}  // namespace

MotionElsewhere::MotionElsewhere(const Config& config, frontend::Frontend& frontend, StepBuilder& steps,
                                 Confirmation& confirmation, const Acceptance& acceptance)
    : config_(config),
      limits_(limits_of_global_matches(config)),
      frontend_(frontend),
      steps_(steps),
      confirmation_(confirmation),
      acceptance_(acceptance) {}

Elsewhere MotionElsewhere::find(const MotionQuery& query, const MotionStep& chosen) {
  const Eigen::Isometry3d by_chosen = motion_since(query.base, query, chosen);
  frontend::predict_positions(steps_.calibration(), query.base->edges, steps_.measured(*query.base), by_chosen,
                              config_.temporal.radius, 1, predicted_);
  const StereoEdges& current = query.current->edges;
  const int wanted = std::max(1, config_.temporal.wide_edges / kElsewhereThinning);
  take_free(chosen.cells, predicted_.left.x, predicted_.left.y, wanted, among_.of_base);
  take_free(chosen.cells, current.left_x, current.left_y, 2 * wanted, among_.of_current);
  const StepHandle proposed = steps_.take(query.base);
  frontend_.match_globally(*query.base, among_, proposed->matches);
  steps_.propose(query, limits_, std::nullopt, *proposed);
  if (!proposed->ok()) return {};
  const StepHandle other = confirmation_.confirm_beside(query, proposed->motion.current_from_previous, chosen.cells);
  if (!other->ok()) return {};
  const ExplainedCells cells = acceptance_.explained_beside(*other, by_chosen, config_.pose.inlier_distance);
  const int searched = chosen.cells.count(false), following = cells.count(true);
  const double count = following;
  Elsewhere found;
  found.area = count / std::max(1, searched + chosen.cells.count(true));
  found.ratio = count / std::max(1, searched);
  found.spread = cells.spread(true) / std::max(1e-9, chosen.cells.spread(false));
  return found;
}

}  // namespace quadedge::motion
