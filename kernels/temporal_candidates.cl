// temporal_candidates.cl: filters 1 and 2 of the temporal cascade: displacement and orientation, for the left or the
// right images.
//
// Needs edge_positions.cl and indexed_points.cl. In: predicted positions of the base's stereo edges in the current
// image (NaN: none), the point index of the current stereo edges of that side. Row r belongs to base edge r * row_step.
// Out: candidate lists in compressed rows, targets are current stereo edges in the order of the point index.
// One work-item = one row, which tests LANES points of the index at once. Two launches: count, then (after an exclusive
// scan) fill. With HALF_TURN directions are compared modulo half a turn.
// Reference: host/workbench/reference/temporal_matching.cpp.

#define LANES 16

// Visits the points [begin, end) of the index, which holds `total`, and writes at most `room` of those that pass to
// target[].
static inline int visit_points(const float3 predicted, const PointIndex* index, int begin, const int end,
                               const int total, const float radius, const float orientation, global int* target,
                               const int room, int count) {
  const float x = predicted.x, y = predicted.y, direction = predicted.z;
  // The same tests in the same arithmetic. Points behind the last one are read and left out.
  for (const int last = min(end - 1, total - LANES); begin <= last; begin += LANES) {
    const float16 dx = LOAD(index->x + begin) - x, dy = LOAD(index->y + begin) - y;
    const float16 turn = TURN_BETWEEN16(LOAD(index->direction + begin), direction);
    uint passing = lane_bits(dx * dx + dy * dy <= radius * radius) & lane_bits(turn <= orientation);
    if (end - begin < LANES) passing &= (1u << (uint)(end - begin)) - 1u;
    if (room == 0) {
      count += (int)popcount(passing);
      continue;
    }
#ifdef PACKED_LANES
    if (count + LANES <= room) {
      STORE(PACKED_LANES(as_int16(LOAD(index->number + begin)), passing), target + count);
      count += (int)popcount(passing);
      continue;
    }
#endif
    for (; passing != 0u; passing &= passing - 1u, ++count) {
      if (count < room) target[count] = index->number[begin + lowest_bit(passing)];
    }
  }
  for (int k = begin; k < end; ++k) {
    const float dx = index->x[k] - x, dy = index->y[k] - y;
    if (dx * dx + dy * dy > radius * radius) continue;
    if (TURN_BETWEEN(index->direction[k], direction) > orientation) continue;
    if (count < room) target[count] = index->number[k];
    ++count;
  }
  return count;
}

static inline int visit_near(const float3 predicted, const PointIndex* index, const int total, const float radius,
                             const float orientation, global int* target, const int room) {
  const float x = predicted.x, y = predicted.y, direction = predicted.z;
  if (!(isfinite(x) && isfinite(y) && isfinite(direction))) return 0;
  const int columns = index->columns, rows = index->rows;
  const int first_column = cell_of(x - radius, kCellWidth, columns),
            last_column = cell_of(x + radius, kCellWidth, columns);
  const int last_row = cell_of(y + radius, kCellHeight, rows);
  int count = 0;
  for (int row = cell_of(y - radius, kCellHeight, rows); row <= last_row; ++row) {
    count = visit_points(predicted, index, index->cell_first[row * columns + first_column],
                         index->cell_first[row * columns + last_column + 1], total, radius, orientation, target, room,
                         count);
  }
  return count;
}

kernel void temporal_candidates_count(const TemporalCandidateArguments args, global const float* predicted,
                                      global const float* points, global const int* cells, global int* counts) {
  const int row = (int)get_global_id(0);
  if (row >= args.rows) return;
  const PointIndex index = open_index(args.index, points, cells);
  counts[row] = visit_near(edge_at(args.predicted, predicted, row * args.row_step), &index, args.index.points.count,
                           args.radius, args.orientation, 0, 0);
}

// Rows beyond the capacity stay empty: the host reads the total, enlarges the buffers and runs the sweep again.
kernel void temporal_candidates_fill(const TemporalCandidateArguments args, global const float* predicted,
                                     global const float* points, global const int* cells, global const int* first,
                                     const int capacity, global int* target) {
  const int row = (int)get_global_id(0);
  if (row >= args.rows) return;
  const int room = min(first[row + 1], capacity) - first[row];
  if (room <= 0) return;
  const PointIndex index = open_index(args.index, points, cells);
  visit_near(edge_at(args.predicted, predicted, row * args.row_step), &index, args.index.points.count, args.radius,
             args.orientation, target + first[row], room);
}
