// temporal_candidates.cl: filters 1 and 2 of the temporal cascade: displacement and orientation, for the left or the
// right images.
//
// Needs point_index.cl. In: predicted positions and directions of the base's stereo edges in the current image (NaN:
// none), the current stereo edges of that side in the order of their point index, with the index. Row r belongs to base
// edge r * row_step.
// Out: candidate lists in compressed rows, targets are current stereo edges in the order of the point index.
// One work-item = one row. Two launches: count, then (after an exclusive scan) fill.
// Reference: host/reference/temporal_candidates.cpp.

inline int visit_near(const float x, const float y, const float direction, global const float* xs,
                      global const float* ys, global const float* directions, global const int* numbers,
                      global const int* cell_first, const int columns, const int rows, const float radius,
                      const float orientation, global int* target, const int room) {
  if (!(isfinite(x) && isfinite(y) && isfinite(direction))) return 0;
  const int first_column = cell_of(x - radius, kCellWidth, columns),
            last_column = cell_of(x + radius, kCellWidth, columns);
  const int last_row = cell_of(y + radius, kCellHeight, rows);
  int count = 0;
  for (int row = cell_of(y - radius, kCellHeight, rows); row <= last_row; ++row) {
    const int end = cell_first[row * columns + last_column + 1];
    for (int k = cell_first[row * columns + first_column]; k < end; ++k) {
      const float dx = xs[k] - x, dy = ys[k] - y;
      if (dx * dx + dy * dy > radius * radius) continue;
      if (angle_between(directions[k], direction) > orientation) continue;
      if (count < room) target[count] = numbers[k];
      ++count;
    }
  }
  return count;
}

kernel void temporal_candidates_count(const TemporalCandidateArguments args, global const float* predicted_x,
                                      global const float* predicted_y, global const float* predicted_direction,
                                      global const float* xs, global const float* ys, global const float* directions,
                                      global const int* numbers, global const int* cell_first, global int* counts) {
  const int row = (int)get_global_id(0);
  if (row >= args.rows) return;
  const int i = row * args.row_step;
  counts[row] = visit_near(predicted_x[i], predicted_y[i], predicted_direction[i], xs, ys, directions, numbers,
                           cell_first, args.columns, args.cell_rows, args.radius, args.orientation, 0, 0);
}

// Rows beyond the capacity stay empty: the host sees the total, makes room and runs again.
kernel void temporal_candidates_fill(const TemporalCandidateArguments args, global const float* predicted_x,
                                     global const float* predicted_y, global const float* predicted_direction,
                                     global const float* xs, global const float* ys, global const float* directions,
                                     global const int* numbers, global const int* cell_first, global const int* first,
                                     const int capacity, global int* target) {
  const int row = (int)get_global_id(0);
  if (row >= args.rows) return;
  const int i = row * args.row_step;
  const int room = min(first[row + 1], capacity) - first[row];
  if (room <= 0) return;
  visit_near(predicted_x[i], predicted_y[i], predicted_direction[i], xs, ys, directions, numbers, cell_first,
             args.columns, args.cell_rows, args.radius, args.orientation, target + first[row], room);
}
