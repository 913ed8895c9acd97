#include "reference/stereo_candidates.hpp"

#include <algorithm>
#include <cmath>

#include "common/numeric.hpp"

namespace quadedge::reference {

Candidates stereo_candidates(const EdgeSet& left, const EdgeSet& right, const EpipolarGeometry& geometry,
                             const DisparityProbe& probe) {
  Candidates candidates;
  candidates.first.assign(1, 0);
  const int last_row = static_cast<int>(right.row_first.size()) - 2;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const EpipolarLine line = epipolar_line(geometry, left.x[i], left.y[i]);
    if (line.valid &&
        left_epipolar_sine(geometry, left.x[i], left.y[i], left.direction[i]) >= geometry.min_epipolar_sine) {
      const bool is_probe = probe.step > 0 && i % static_cast<std::size_t>(probe.step) == 0;
      const float s_max = is_probe ? std::max(line.s_max, probe.max_disparity) : line.s_max;
      const float s_low = -geometry.tolerance, s_high = s_max + geometry.tolerance;
      const float end_a = line.y + s_low * line.ey, end_b = line.y + s_high * line.ey;
      // Rows that the segment can touch; one row on either side for the sub-pixel shift.
      const float reach = geometry.epipolar_distance + 1.0f;
      const auto row = [&](float y) {
        return std::clamp(static_cast<int>(std::clamp(y, -1e6f, 1e6f)), 0, std::max(last_row, 0));
      };
      const auto begin =
          static_cast<std::size_t>(right.row_first[static_cast<std::size_t>(row(std::min(end_a, end_b) - reach))]);
      const auto end =
          static_cast<std::size_t>(right.row_first[static_cast<std::size_t>(row(std::max(end_a, end_b) + reach)) + 1]);
      for (std::size_t j = begin; j < end; ++j) {
        const float dx = right.x[j] - line.x, dy = right.y[j] - line.y;
        const float s = dx * line.ex + dy * line.ey;
        const float distance = std::fabs(dx * -line.ey + dy * line.ex);
        if (distance > geometry.epipolar_distance || s < s_low || s > s_high) continue;
        if (angle_between(right.direction[j], left.direction[i]) > geometry.orientation) continue;
        candidates.target.push_back(static_cast<std::int32_t>(j));
      }
    }
    candidates.first.push_back(static_cast<std::int32_t>(candidates.target.size()));
  }
  return candidates;
}

}  // namespace quadedge::reference
