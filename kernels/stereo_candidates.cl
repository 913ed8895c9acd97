// stereo_candidates.cl: filters 1 to 3 of the stereo cascade in one sweep: epipolar proximity, limited disparity,
// orientation.
//
// Needs direction.cl and epipolar.cl. In: left and right edges (scan order, with the right rows' starts), packed
// epipolar geometry.
// Out: candidate lists in compressed rows, targets in the scan order of the right edges; which right edges are listed
// (1, else 0).
// One work-item = one left edge, which tests LANES right edges at once. Two launches: count, then (after an exclusive
// scan) fill. With HALF_TURN directions are compared modulo half a turn.
// Reference: host/workbench/reference/stereo_matching.cpp.

// A position differs from that of its pixel by at most this along both axes [px] (kEdgeRowReach in
// include/quadedge/edges.hpp).
#define EDGE_REACH 0.75f

#define LANES 16

// An index in [begin, end) before which no x reaches `x`: positions within a row are ordered up to twice this reach;
// fewer than LANES edges follow it that do not reach `x` either; they are tested with the others.
static inline int lower_bound_x(global const float* xs, int begin, int end, const float x) {
  while (end - begin >= LANES) {
    const int middle = (begin + end) / 2;
    const int below = xs[middle] < x;
    begin = below ? middle + 1 : begin;
    end = below ? end : middle;
  }
  return begin;
}

// Conditions on the right edges of a row.
typedef struct {
  EpipolarLine line;
  float direction;         // of the left edge
  float tau, orientation;  // largest distance from the line, largest turn
  float s_low, s_high;     // positions on the line
  float nx, ny;            // the line's normal
} Wanted;

static inline int passes(const Wanted* wanted, const float x, const float y, const float direction) {
  const float dx = x - wanted->line.x, dy = y - wanted->line.y;
  const float s = dx * wanted->line.ex + dy * wanted->line.ey;
  const float distance = fabs(dx * wanted->nx + dy * wanted->ny);
  return !(distance > wanted->tau || s < wanted->s_low || s > wanted->s_high) &&
         !(TURN_BETWEEN(direction, wanted->direction) > wanted->orientation);
}

// Visits the right edges [begin, end) of a row up to x = `to` and writes at most `room` of those that pass to target[].
static inline int visit_row(const Wanted* wanted, global const float* xs, global const float* ys,
                            global const float* directions, int begin, const int end, const int total, const float to,
                            global int* target, const int room, int count) {
  // The same tests in the same arithmetic. Edges beyond the row's end are read and left out.
  for (const int last = min(end - 1, total - LANES); begin <= last; begin += LANES) {
    const float16 x = LOAD(xs + begin);
    const float16 dx = x - wanted->line.x, dy = LOAD(ys + begin) - wanted->line.y;
    const float16 s = dx * wanted->line.ex + dy * wanted->line.ey;
    const float16 distance = fabs(dx * wanted->nx + dy * wanted->ny);
    const float16 turn = TURN_BETWEEN16(LOAD(directions + begin), wanted->direction);
    uint passing = lane_bits(distance <= wanted->tau) & lane_bits(s >= wanted->s_low) & lane_bits(s <= wanted->s_high) &
                   lane_bits(turn <= wanted->orientation);
    if (end - begin < LANES) passing &= (1u << (uint)(end - begin)) - 1u;
#ifdef PACKED_LANES
    if (count + LANES <= room) {
      const int16 lanes = begin + (int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
      STORE(PACKED_LANES(lanes, passing), target + count);
      count += (int)popcount(passing);
      passing = 0u;
    }
#endif
    for (; passing != 0u; passing &= passing - 1u, ++count) {
      if (count < room) target[count] = begin + lowest_bit(passing);
    }
    if (x.sf > to) return count;
  }
  for (int j = begin; j < end && xs[j] <= to; ++j) {
    if (!passes(wanted, xs[j], ys[j], directions[j])) continue;
    if (count < room) target[count] = j;
    ++count;
  }
  return count;
}

// Visits every right edge that passes, at least up to disparity `probed`; writes to target[] while fewer than `room`
// are written.
static inline int visit_candidates(const float x, const float y, const float direction, global const float* right_x,
                                   global const float* right_y, global const float* right_direction,
                                   global const int* right_row_first, const int right_height, const EpipolarGeometry* g,
                                   const float probed, global int* target, const int room) {
  if (left_epipolar_sine(g, x, y, direction) < g->min_epipolar_sine) return 0;
  EpipolarLine line = epipolar_line(g, x, y);
  if (!line.valid) return 0;
  line.s_max = fmax(line.s_max, probed);
  const Wanted wanted = {line,           direction,     g->epipolar_distance,
                         g->orientation, -g->tolerance, line.s_max + g->tolerance,
                         -line.ey,       line.ex};
  const float ax = line.x + wanted.s_low * line.ex, bx = line.x + wanted.s_high * line.ex;
  const float ay = line.y + wanted.s_low * line.ey, by = line.y + wanted.s_high * line.ey;
  const float x_low = fmin(ax, bx) - wanted.tau, x_high = fmax(ax, bx) + wanted.tau;
  const float last_row = (float)(right_height - 1);
  const int row_low = (int)clamp(floor(fmin(ay, by) - wanted.tau - EDGE_REACH), 0.0f, last_row);
  const int row_high = (int)clamp(ceil(fmax(ay, by) + wanted.tau + EDGE_REACH), 0.0f, last_row);
  const int total = right_row_first[right_height];
  int count = 0;
  for (int row = row_low; row <= row_high; ++row) {
    float from = x_low, to = x_high;
    if (fabs(wanted.nx) > 1e-4f) {
      const float center = line.x - wanted.ny * ((float)row - line.y) / wanted.nx;
      const float reach = (wanted.tau + EDGE_REACH * fabs(wanted.ny)) / fabs(wanted.nx) + 0.01f;
      from = fmax(from, center - reach);
      to = fmin(to, center + reach);
    }
    const int end = right_row_first[row + 1];
    const int begin = lower_bound_x(right_x, right_row_first[row], end, from - 2.0f * EDGE_REACH);
    count = visit_row(&wanted, right_x, right_y, right_direction, begin, end, total, to + 2.0f * EDGE_REACH, target,
                      room, count);
  }
  return count;
}

// The candidates of left edge i.
static inline int visit_row_of(const StereoCandidateArguments* args, const int i, global const float* left_edges,
                               global const float* right_edges, global const int* right_row_first, global int* target,
                               const int room) {
  global const float* left = left_edges + args->left.first + i;
  global const float* right = right_edges + args->right.first;
  const int is_probe = args->probe.step > 0 && i % args->probe.step == 0;
  return visit_candidates(left[0], left[args->left.stride], left[2 * args->left.stride], right,
                          right + args->right.stride, right + 2 * args->right.stride, right_row_first,
                          args->right_height, &args->geometry, is_probe ? args->probe.max_disparity : 0.0f, target,
                          room);
}

kernel void stereo_candidates_count(const StereoCandidateArguments args, global const float* left_edges,
                                    global const float* right_edges, global const int* right_row_first,
                                    global int* counts, global int* noted, global int* listed) {
  const int i = (int)get_global_id(0);
  if (i >= args.left.count) return;
  for (int j = i; j < args.right.count; j += args.left.count) listed[j] = 0;
  counts[i] =
      visit_row_of(&args, i, left_edges, right_edges, right_row_first, noted + i * kNotedCandidates, kNotedCandidates);
}

// Copies the candidates stored by the first sweep; only rows with more candidates sweep again. Rows beyond the capacity
// stay empty: the host reads the total, enlarges the buffers and runs the sweep again.
kernel void stereo_candidates_fill(const StereoCandidateArguments args, global const float* left_edges,
                                   global const float* right_edges, global const int* right_row_first,
                                   global const int* first, const int capacity, global const int* noted,
                                   global int* target, global int* listed) {
  const int i = (int)get_global_id(0);
  if (i >= args.left.count) return;
  const int room = min(first[i + 1], capacity) - first[i];
  if (room <= 0) return;
  global int* own = target + first[i];
  if (room <= kNotedCandidates) {
    for (int k = 0; k < room; ++k) own[k] = noted[i * kNotedCandidates + k];
  } else {
    visit_row_of(&args, i, left_edges, right_edges, right_row_first, own, room);
  }
  for (int k = 0; k < room; ++k) listed[own[k]] = 1;
}
