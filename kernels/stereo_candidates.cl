// stereo_candidates.cl: filters 1 to 3 of the stereo cascade in one sweep: epipolar proximity, limited disparity, orientation.
//
// Needs direction.cl and epipolar.cl. In: left and right edges (scan order, with the right rows' starts), packed epipolar geometry.
// Out: candidate lists in compressed rows, targets in the scan order of the right edges.
// One work-item = one left edge. Two launches: count, then (after an exclusive scan) fill.
// Reference: host/reference/stereo_candidates.cpp.

// Candidates per row that the first sweep can note (kNoted in host/stages/stereo_candidates.cpp).
#define NOTED 32

// A position differs from its cell of the doubled grid by at most this [px] (kEdgeRowReach in host/reference/edges.hpp).
#define CELL_SLACK 0.5f

// First index in [begin, end) whose x may reach `x`: positions within a row are ordered up to twice the slack.
inline int lower_bound_x(global const float* xs, int begin, int end, const float x) {
  while (begin < end) {
    const int middle = (begin + end) / 2;
    if (xs[middle] < x) begin = middle + 1; else end = middle;
  }
  return begin;
}

// Visits every right edge that passes; writes to target[] where it is not null and fewer than `room` are written.
inline int visit_candidates(const float x, const float y, const float direction, global const float* right_x,
                            global const float* right_y, global const float* right_direction,
                            global const int* right_row_first, const int right_height, global const float* g,
                            global int* target, const int room) {
  if (left_epipolar_sine(g, x, y, direction) < g[GEOMETRY_MIN_EPIPOLAR_SINE]) return 0;
  const EpipolarLine line = epipolar_line(g, x, y);
  if (!line.valid) return 0;
  const float tau = g[GEOMETRY_EPIPOLAR_DISTANCE];
  const float s_low = -g[GEOMETRY_TOLERANCE], s_high = line.s_max + g[GEOMETRY_TOLERANCE];
  const float orientation = g[GEOMETRY_ORIENTATION];
  const float nx = -line.ey, ny = line.ex;
  const float ax = line.x + s_low * line.ex, bx = line.x + s_high * line.ex;
  const float ay = line.y + s_low * line.ey, by = line.y + s_high * line.ey;
  const float x_low = fmin(ax, bx) - tau, x_high = fmax(ax, bx) + tau;
  const float last_row = (float)(2 * right_height - 1);
  const int row_low = (int)clamp(floor(2.0f * (fmin(ay, by) - tau - CELL_SLACK)), 0.0f, last_row);
  const int row_high = (int)clamp(ceil(2.0f * (fmax(ay, by) + tau + CELL_SLACK)), 0.0f, last_row);
  int count = 0;
  for (int row = row_low; row <= row_high; ++row) {
    float from = x_low, to = x_high;
    if (fabs(nx) > 1e-4f) {
      const float center = line.x - ny * (0.5f * (float)row - line.y) / nx;
      const float reach = (tau + CELL_SLACK * fabs(ny)) / fabs(nx) + 0.01f;
      from = fmax(from, center - reach);
      to = fmin(to, center + reach);
    }
    const int end = right_row_first[row + 1];
    for (int j = lower_bound_x(right_x, right_row_first[row], end, from - 2.0f * CELL_SLACK); j < end; ++j) {
      const float dx = right_x[j] - line.x;
      if (right_x[j] > to + 2.0f * CELL_SLACK) break;
      const float dy = right_y[j] - line.y;
      const float s = dx * line.ex + dy * line.ey;
      const float distance = fabs(dx * nx + dy * ny);
      if (distance > tau || s < s_low || s > s_high) continue;
      if (angle_between(right_direction[j], direction) > orientation) continue;
      if (count < room) target[count] = j;
      ++count;
    }
  }
  return count;
}

kernel void stereo_candidates_count(global const float* left_x, global const float* left_y, global const float* left_direction,
                                    const int left_count, global const float* right_x, global const float* right_y,
                                    global const float* right_direction, global const int* right_row_first,
                                    const int right_height, global const float* geometry, global int* counts,
                                    global int* noted) {
  const int i = (int)get_global_id(0);
  if (i >= left_count) return;
  counts[i] = visit_candidates(left_x[i], left_y[i], left_direction[i], right_x, right_y, right_direction, right_row_first,
                               right_height, geometry, noted + i * NOTED, NOTED);
}

// Copies what the first sweep noted; only rows with more candidates than that sweep again. Rows beyond the capacity stay empty: the host sees the total, makes room and runs again.
kernel void stereo_candidates_fill(global const float* left_x, global const float* left_y, global const float* left_direction,
                                   const int left_count, global const float* right_x, global const float* right_y,
                                   global const float* right_direction, global const int* right_row_first,
                                   const int right_height, global const float* geometry, global const int* first,
                                   const int capacity, global const int* noted, global int* target) {
  const int i = (int)get_global_id(0);
  if (i >= left_count) return;
  const int room = min(first[i + 1], capacity) - first[i];
  if (room <= 0) return;
  if (room <= NOTED) {
    for (int k = 0; k < room; ++k) target[first[i] + k] = noted[i * NOTED + k];
    return;
  }
  visit_candidates(left_x[i], left_y[i], left_direction[i], right_x, right_y, right_direction, right_row_first, right_height,
                   geometry, target + first[i], room);
}
