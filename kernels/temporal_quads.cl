// temporal_quads.cl: the circle is closed (a candidate must be alive in the left and in the right images), and the best
// of what remains makes the quad.
//
// Row r belongs to previous stereo edge r * row_step. Reference: host/reference/temporal_quads.cpp.

// One work-item = one row. A living left candidate stays if the right list holds the same current edge alive; `score`
// becomes the mean of both NCC.
kernel void temporal_agreement(global const int* left_first, global const int* left_target, const int left_capacity,
                               global const float* left_ncc, global uchar* left_state, global const int* right_first,
                               global const int* right_target, const int right_capacity, global const float* right_ncc,
                               global const uchar* right_state, const int rows, const int rejected_order,
                               global float* score) {
  const int row = (int)get_global_id(0);
  if (row >= rows) return;
  const int left_end = min(left_first[row + 1], left_capacity), right_end = min(right_first[row + 1], right_capacity);
  for (int c = left_first[row]; c < left_end; ++c) {
    if (left_state[c] != kCandidateAlive) continue;
    int found = -1;
    for (int d = right_first[row]; d < right_end && found < 0; ++d) {
      if (right_state[d] == kCandidateAlive && right_target[d] == left_target[c]) found = d;
    }
    if (found < 0) {
      left_state[c] = (uchar)rejected_order;
    } else {
      score[c] = 0.5f * (left_ncc[c] + right_ncc[found]);
    }
  }
}

// A stereo edge's arrays come packed in blocks of `count` floats: left x, y, direction, then the right ones.
#define LEFT_X(edges, count, i) (edges)[i]
#define LEFT_Y(edges, count, i) (edges)[(count) + (i)]
#define LEFT_DIRECTION(edges, count, i) (edges)[2 * (count) + (i)]

// One work-item = one row. Joins living candidates whose left places chain up within cluster_gap with directions within
// cluster_orientation. The member with the highest score wins; a score counts less by distance_weight (1 / px^2) for
// the squared distance from the predicted left place.
// Out per row: best (current edge, -1: none), rivals (other clusters) and score. `label` is scratch.
kernel void temporal_best(global const int* first, global const int* target, const int capacity, const int rows,
                          const int row_step, global const float* current, const int current_count,
                          global const uchar* state, global const float* score, global const float* predicted_x,
                          global const float* predicted_y, const float distance_weight, const float cluster_gap,
                          const float cluster_orientation, global int* label, global int* best, global int* rivals,
                          global float* best_score) {
  const int row = (int)get_global_id(0);
  if (row >= rows) return;
  const int begin = first[row], end = min(first[row + 1], capacity);
  int winner = -1;
  float highest = 0.0f;
  for (int c = begin; c < end; ++c) {
    label[c] = state[c] == kCandidateAlive ? c : -1;
    if (label[c] < 0) continue;
    const float dx = LEFT_X(current, current_count, target[c]) - predicted_x[row * row_step];
    const float dy = LEFT_Y(current, current_count, target[c]) - predicted_y[row * row_step];
    const float weighed = score[c] - distance_weight * (dx * dx + dy * dy);
    if (winner >= 0 && weighed <= highest) continue;
    winner = c;
    highest = weighed;
  }
  best[row] = winner < 0 ? -1 : target[winner];
  if (winner < 0) return;
  for (int changed = 1; changed;) {
    changed = 0;
    for (int c = begin; c < end; ++c) {
      if (label[c] < 0) continue;
      for (int d = begin; d < c; ++d) {
        if (label[d] < 0 || label[d] == label[c]) continue;
        const float dx = LEFT_X(current, current_count, target[c]) - LEFT_X(current, current_count, target[d]);
        const float dy = LEFT_Y(current, current_count, target[c]) - LEFT_Y(current, current_count, target[d]);
        if (dx * dx + dy * dy >= cluster_gap * cluster_gap) continue;
        if (angle_between(LEFT_DIRECTION(current, current_count, target[c]),
                          LEFT_DIRECTION(current, current_count, target[d])) > cluster_orientation) {
          continue;
        }
        label[c] = label[d] = min(label[c], label[d]);
        changed = 1;
      }
    }
  }
  int clusters = 0;
  for (int c = begin; c < end; ++c) clusters += label[c] == c;
  rivals[row] = clusters - 1;
  best_score[row] = score[winner];
}
