// temporal_candidates.cl: filters 1 and 2 of the temporal cascade: displacement and orientation, for the left or the right images.
//
// In: predicted places and directions of the previous stereo edges in the current image (NaN: none), the current stereo edges
// (packed as stereo_collect writes them; side 0 left, 1 right) with that image's point index (host/stages/point_index.hpp). Row r belongs to previous edge r * row_step.
// Out: candidate lists in compressed rows, targets are current stereo edges in the order of the point index.
// One work-item = one row. Two launches: count, then (after an exclusive scan) fill.
// Reference: host/reference/temporal_candidates.cpp.

inline int visit_near(const float x, const float y, const float direction, global const float* current,
                      const int stride, global const int* row_first,
                      global const int* order, const int height, const float radius, const float orientation,
                      global int* target, const int room) {
  if (!(isfinite(x) && isfinite(y) && isfinite(direction))) return 0;
  const float last_row = (float)(2 * height - 1);
  if (y + radius < -0.5f || y - radius > (float)height) return 0;
  const int row_low = (int)clamp(floor(2.0f * (y - radius)), 0.0f, last_row);
  const int row_high = (int)clamp(ceil(2.0f * (y + radius)), 0.0f, last_row);
  int count = 0;
  for (int row = row_low; row <= row_high; ++row) {
    int begin = row_first[row];
    const int end = row_first[row + 1];
    for (int last = end; begin < last;) {
      const int middle = (begin + last) / 2;
      if (current[order[middle]] < x - radius) begin = middle + 1; else last = middle;
    }
    for (int k = begin; k < end; ++k) {
      const int j = order[k];
      const float dx = current[j] - x;
      if (dx > radius) break;
      const float dy = current[stride + j] - y;
      if (dx * dx + dy * dy > radius * radius) continue;
      if (angle_between(current[2 * stride + j], direction) > orientation) continue;
      if (count < room) target[count] = j;
      ++count;
    }
  }
  return count;
}

kernel void temporal_candidates_count(global const float* predicted_x, global const float* predicted_y,
                                      global const float* predicted_direction, const int rows, const int row_step,
                                      global const float* current, const int stride, const int side,
                                      global const int* row_first,
                                      global const int* order, const int height, const float radius, const float orientation,
                                      global int* counts) {
  const int row = (int)get_global_id(0);
  if (row >= rows) return;
  const int i = row * row_step;
  counts[row] = visit_near(predicted_x[i], predicted_y[i], predicted_direction[i], current + 3 * side * stride, stride,
                           row_first, order, height, radius, orientation, 0, 0);
}

// Rows beyond the capacity stay empty: the host sees the total, makes room and runs again.
kernel void temporal_candidates_fill(global const float* predicted_x, global const float* predicted_y,
                                     global const float* predicted_direction, const int rows, const int row_step,
                                     global const float* current, const int stride, const int side,
                                     global const int* row_first,
                                     global const int* order, const int height, const float radius, const float orientation,
                                     global const int* first, const int capacity, global int* target) {
  const int row = (int)get_global_id(0);
  if (row >= rows) return;
  const int i = row * row_step;
  const int room = min(first[row + 1], capacity) - first[row];
  if (room <= 0) return;
  visit_near(predicted_x[i], predicted_y[i], predicted_direction[i], current + 3 * side * stride, stride, row_first, order,
             height, radius, orientation, target + first[row], room);
}
