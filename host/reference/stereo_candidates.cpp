#include "reference/stereo_candidates.hpp"

#include <algorithm>
#include <cmath>

namespace quadedge::reference {
namespace {

constexpr float kPi = 3.14159265358979f;

}  // namespace

float angle_between(float a, float b) {
  const float d = std::fabs(a - b);
  return d > kPi ? 2.0f * kPi - d : d;
}

float line_angle_between(float a, float b) {
  const float d = angle_between(a, b);
  return d > 0.5f * kPi ? kPi - d : d;
}

EpipolarLine epipolar_line(const stages::EpipolarGeometry& g, float x, float y) {
  EpipolarLine line;
  const float hx = g.h[0] * x + g.h[1] * y + g.h[2];
  const float hy = g.h[3] * x + g.h[4] * y + g.h[5];
  const float hz = g.h[6] * x + g.h[7] * y + g.h[8];
  line.x = hx / hz;
  line.y = hy / hz;
  const float dx = g.t[0] - line.x * g.t[2];
  const float dy = g.t[1] - line.y * g.t[2];
  const float length = std::sqrt(dx * dx + dy * dy);
  line.valid = hz > 1e-6f && length > 1e-6f;
  line.ex = dx / length;
  line.ey = dy / length;
  line.s_max = g.max_disparity;
  if (g.inverse_min_depth > 0.0f) {
    const float w = g.inverse_min_depth;
    const float nz = hz + w * g.t[2];
    const float nx = (hx + w * g.t[0]) / nz - line.x;
    const float ny = (hy + w * g.t[1]) / nz - line.y;
    line.s_max = nz > 1e-6f ? std::sqrt(nx * nx + ny * ny) : 1e5f;
  }
  return line;
}

float left_epipolar_sine(const stages::EpipolarGeometry& g, float x, float y, float direction) {
  const float dx = g.epipole[0] - g.epipole[2] * x;
  const float dy = g.epipole[1] - g.epipole[2] * y;
  return std::fabs(std::cos(direction) * dy - std::sin(direction) * dx) / std::sqrt(dx * dx + dy * dy);
}

Candidates stereo_candidates(const EdgeSet& left, const EdgeSet& right, const stages::EpipolarGeometry& geometry) {
  Candidates candidates;
  candidates.first.assign(1, 0);
  const int last_row = static_cast<int>(right.row_first.size()) - 2;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const EpipolarLine line = epipolar_line(geometry, left.x[i], left.y[i]);
    if (line.valid &&
        left_epipolar_sine(geometry, left.x[i], left.y[i], left.direction[i]) >= geometry.min_epipolar_sine) {
      const float s_low = -geometry.tolerance, s_high = line.s_max + geometry.tolerance;
      const float end_a = line.y + s_low * line.ey, end_b = line.y + s_high * line.ey;
      // Rows of the doubled grid that the segment can touch; one row on either side for the sub-pixel shift.
      const float reach = geometry.epipolar_distance + 1.0f;
      const auto row = [&](float y) {
        return std::clamp(static_cast<int>(std::clamp(2.0f * y, -1e6f, 1e6f)), 0, std::max(last_row, 0));
      };
      const auto begin = static_cast<std::size_t>(right.row_first[static_cast<std::size_t>(row(std::min(end_a, end_b) - reach))]);
      const auto end = static_cast<std::size_t>(right.row_first[static_cast<std::size_t>(row(std::max(end_a, end_b) + reach)) + 1]);
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
