#include "reference/temporal_candidates.hpp"

#include <cmath>

#include "common/numeric.hpp"

namespace quadedge::reference {

Candidates temporal_candidates(const EdgePositionsView& predicted, const EdgePositionsView& current,
                               const PointIndex& index, float radius, float orientation, int row_step) {
  Candidates candidates;
  candidates.first.assign(1, 0);
  for (std::size_t i = 0; i < predicted.x.size(); i += static_cast<std::size_t>(row_step)) {
    const float x = predicted.x[i], y = predicted.y[i];
    if (std::isfinite(x) && std::isfinite(y) && std::isfinite(predicted.direction[i])) {
      index.visit_square(x, y, radius, [&](std::int32_t number) {
        const auto j = static_cast<std::size_t>(number);
        const float dx = current.x[j] - x, dy = current.y[j] - y;
        if (dx * dx + dy * dy > radius * radius) return;
        if (angle_between(current.direction[j], predicted.direction[i]) > orientation) return;
        candidates.target.push_back(number);
      });
    }
    candidates.first.push_back(static_cast<std::int32_t>(candidates.target.size()));
  }
  return candidates;
}

}  // namespace quadedge::reference
