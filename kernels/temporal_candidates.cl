// temporal_candidates.cl: filters 1 and 2 of the temporal cascade: displacement and orientation, for the left or the
// right images.
//
// Needs edge_positions.cl and indexed_points.cl. In: predicted positions of the base's stereo edges in the current
// image (NaN: none), the point index of the current stereo edges of that side. Row r belongs to base edge r * row_step.
// Out: candidate lists in compressed rows, targets are current stereo edges in the order of the point index.
// One work-item = one row. Two launches: count, then (after an exclusive scan) fill.
// Reference: host/reference/temporal_matching.cpp.

static inline int visit_near(const float3 predicted, const PointIndex* index, const float radius,
                             const float orientation, global int* target, const int room) {
  const float x = predicted.x, y = predicted.y, direction = predicted.z;
  if (!(isfinite(x) && isfinite(y) && isfinite(direction))) return 0;
  const int columns = index->columns, rows = index->rows;
  const int first_column = cell_of(x - radius, kCellWidth, columns),
            last_column = cell_of(x + radius, kCellWidth, columns);
  const int last_row = cell_of(y + radius, kCellHeight, rows);
  int count = 0;
  for (int row = cell_of(y - radius, kCellHeight, rows); row <= last_row; ++row) {
    const int end = index->cell_first[row * columns + last_column + 1];
    for (int k = index->cell_first[row * columns + first_column]; k < end; ++k) {
      const float dx = index->x[k] - x, dy = index->y[k] - y;
      if (dx * dx + dy * dy > radius * radius) continue;
      if (angle_between(index->direction[k], direction) > orientation) continue;
      if (count < room) target[count] = index->number[k];
      ++count;
    }
  }
  return count;
}

kernel void temporal_candidates_count(const TemporalCandidateArguments args, global const float* predicted,
                                      global const float* points, global const int* cells, global int* counts) {
  const int row = (int)get_global_id(0);
  if (row >= args.rows) return;
  const PointIndex index = open_index(args.index, points, cells);
  counts[row] =
      visit_near(edge_at(args.predicted, predicted, row * args.row_step), &index, args.radius, args.orientation, 0, 0);
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
  visit_near(edge_at(args.predicted, predicted, row * args.row_step), &index, args.radius, args.orientation,
             target + first[row], room);
}
