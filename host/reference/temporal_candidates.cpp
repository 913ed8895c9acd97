#include "reference/temporal_candidates.hpp"

#include <algorithm>
#include <cmath>

namespace quadedge::reference {

Candidates temporal_candidates(const stages::PlacedEdges& predicted, const stages::PlacedEdges& current, const stages::PointIndex& index,
                               float radius, float orientation, int row_step) {
  Candidates candidates;
  candidates.first.assign(1, 0);
  const int last_row = static_cast<int>(index.row_first.size()) - 2;
  for (std::size_t i = 0; i < predicted.x.size(); i += static_cast<std::size_t>(row_step)) {
    const float x = predicted.x[i], y = predicted.y[i];
    if (std::isfinite(x) && std::isfinite(y) && std::isfinite(predicted.direction[i])) {
      const auto row = [&](float value) { return std::clamp(static_cast<int>(std::clamp(value, -1e6f, 1e6f)), 0, last_row); };
      const auto begin = static_cast<std::size_t>(index.row_first[static_cast<std::size_t>(row(2.0f * (y - radius) - 1.0f))]);
      const auto end = static_cast<std::size_t>(index.row_first[static_cast<std::size_t>(row(2.0f * (y + radius) + 1.0f)) + 1]);
      for (std::size_t k = begin; k < end; ++k) {
        const auto j = static_cast<std::size_t>(index.order[k]);
        const float dx = current.x[j] - x, dy = current.y[j] - y;
        if (dx * dx + dy * dy > radius * radius) continue;
        if (angle_between(current.direction[j], predicted.direction[i]) > orientation) continue;
        candidates.target.push_back(static_cast<std::int32_t>(j));
      }
    }
    candidates.first.push_back(static_cast<std::int32_t>(candidates.target.size()));
  }
  return candidates;
}

}  // namespace quadedge::reference
