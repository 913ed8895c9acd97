// temporal_quads.cl: the circle is closed (a candidate must be alive in the left and in the right images), and the best
// of what remains makes the quad.
//
// Needs edge_groups.cl. Row r belongs to stereo edge r * row_step of the base.
// Reference: host/workbench/reference/temporal_matching.cpp.

// One work-item = one row. A living left candidate stays if the right list holds the same current edge alive; `score`
// becomes the mean of both NCC.
kernel void temporal_agreement(const TemporalAgreementArguments args, global const int* left_first,
                               global const int* left_target, global const float* left_ncc, global uchar* left_state,
                               global const int* right_first, global const int* right_target,
                               global const float* right_ncc, global const uchar* right_state, global float* score) {
  const int row = (int)get_global_id(0);
  if (row >= args.rows) return;
  const int left_end = min(left_first[row + 1], args.left_capacity),
            right_end = min(right_first[row + 1], args.right_capacity);
  for (int c = left_first[row]; c < left_end; ++c) {
    if (left_state[c] != kCandidateAlive) continue;
    int found = -1;
    for (int d = right_first[row]; d < right_end && found < 0; ++d) {
      if (right_state[d] == kCandidateAlive && right_target[d] == left_target[c]) found = d;
    }
    if (found < 0) {
      left_state[c] = (uchar)args.rejected_order;
    } else {
      score[c] = 0.5f * (left_ncc[c] + right_ncc[found]);
    }
  }
}

DEFINE_COUNT_GROUPS(count_groups_of_list, global)

// One work-item = one row. Joins living candidates whose left positions chain up within cluster_gap with directions
// within cluster_orientation. The member with the highest score wins; a score counts less by distance_weight for the
// squared distance from the predicted left position.
// Out per row: kQuadRowInts ints (layouts.cl), of which the flags are 0. `label` is scratch.
kernel void temporal_best(const TemporalBestArguments args, global const int* first, global const int* target,
                          global const uchar* state, global const float* score, global const float* predicted,
                          global const float* current, global int* label, global int* result) {
  const int row = (int)get_global_id(0);
  if (row >= args.rows) return;
  const int begin = first[row], end = min(first[row + 1], args.capacity);
  const float3 wanted = edge_at(args.predicted, predicted, row * args.row_step);
  int winner = -1;
  float highest = 0.0f;
  for (int c = begin; c < end; ++c) {
    label[c] = state[c] == kCandidateAlive ? c : -1;
    if (label[c] < 0) continue;
    const float3 edge = edge_at(args.current, current, target[c]);
    const float dx = edge.x - wanted.x, dy = edge.y - wanted.y;
    const float weighed = score[c] - args.choice.distance_weight * (dx * dx + dy * dy);
    if (winner >= 0 && weighed <= highest) continue;
    winner = c;
    highest = weighed;
  }
  if (winner < 0) {
    ((global int4*)result)[row] = (int4)(-1, 0, 0, 0);
    return;
  }
  const int groups = count_groups_of_list(begin, end, target, args.current, current, &args.choice, label);
  ((global int4*)result)[row] = (int4)(target[winner], groups - 1, as_int(score[winner]), 0);
}
