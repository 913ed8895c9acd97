// temporal_match.cl: the whole temporal cascade of one row in one work-item: displacement, orientation, NCC and nearly
// best NCC in both images, agreement, the best and the competing clusters. The same as
// temporal_candidates.cl, candidate_filters.cl without SIFT and temporal_quads.cl one after the other, without lists in
// global memory.
//
// Needs similarity.cl, edge_groups.cl and indexed_points.cl. In: predicted positions of the base's stereo edges in
// both current images (NaN: none), the point indices of the current stereo edges of both sides, side patches, with the
// number of each stereo edge's left patch; right patches are in the order of the stereo edges.
// Out per row, which belongs to base edge row * row_step: kQuadRowInts ints (layouts.cl).
// A work-item tests LANES points of the index at once, and asks for memory ahead: for CPUs.
// Reference: host/workbench/reference/temporal_matching.cpp.

// Maximum number of candidates per row and side; rows with more are flagged and have no result.
#define MOST 160
#define LANES 16

// Prefetches the two cache lines of a patch on CPUs, where OpenCL's own prefetch() does nothing (PoCL).
static inline void ask_for_patch(global const char* patch) {
#if defined(__x86_64__) || defined(__aarch64__)
  __builtin_prefetch(patch);
  __builtin_prefetch(patch + 64);
#else
  (void)patch;
#endif
}

// One side's candidates that pass the filters, in the order of the index. Returns their number, -1: no room.
// patch_numbers: of the stereo edges' patches; 0: those of the edges.
// LONG: a row's candidates from the index to the nearly best; they stay in private memory.
static inline int similar_near(const TemporalMatchArguments* args, const float3 predicted, const PointIndex* index,
                               global const char* patch, global const char* patches, global const int* patch_numbers,
                               int* target, float* ncc) {
  const float x = predicted.x, y = predicted.y, direction = predicted.z;
  if (!(isfinite(x) && isfinite(y) && isfinite(direction))) return 0;
  global const float *xs = index->x, *ys = index->y, *directions = index->direction;
  global const int *numbers = index->number, *cell_first = index->cell_first;
  const int columns = index->columns, rows = index->rows;
  const float radius = args->radius, orientation = args->orientation;
  const int first_column = cell_of(x - radius, kCellWidth, columns),
            last_column = cell_of(x + radius, kCellWidth, columns);
  const int last_row = cell_of(y + radius, kCellHeight, rows);
  const int total = cell_first[columns * rows];
  const float16 full_turn = 2.0f * PI_F;
  int near = 0;
  for (int row = cell_of(y - radius, kCellHeight, rows); row <= last_row; ++row) {
    const int end = cell_first[row * columns + last_column + 1];
    int k = cell_first[row * columns + first_column];
    // The same tests in the same arithmetic. Points beyond the cells are read and left out.
    for (const int last = min(end - 1, total - LANES); k <= last && near <= MOST - LANES; k += LANES) {
      const float16 dx = LOAD(xs + k) - x, dy = LOAD(ys + k) - y, turn = fabs(LOAD(directions + k) - direction);
      const uint close = lane_bits(dx * dx + dy * dy <= radius * radius);
      const uint lanes = end - k < LANES ? (1u << (uint)(end - k)) - 1u : ~0u;
      const uint passing = close & lane_bits(min(turn, full_turn - turn) <= orientation) & lanes;
#ifdef PACKED_LANES
      ((packed16*)(target + near))->lanes = PACKED_LANES(as_int16(LOAD(numbers + k)), passing);
      near += (int)popcount(passing);
#else
      for (uint left = passing; left != 0u; left &= left - 1u) target[near++] = numbers[k + lowest_bit(left)];
#endif
    }
    for (; k < end; ++k) {
      const float dx = xs[k] - x, dy = ys[k] - y;
      if (dx * dx + dy * dy > radius * radius) continue;
      if (angle_between(directions[k], direction) > orientation) continue;
      if (near == MOST) return -1;
      target[near++] = numbers[k];
    }
  }
  // The patches are scattered in memory: all are prefetched before the first is used.
  for (int c = 0; c < near; ++c) ask_for_patch(patch_of(patches, patch_numbers, target[c]));
  int similar = 0;
  float best = 0.0f;
  for (int c = 0; c < near; ++c) {
    const float similarity = patch_ncc(patch, patch_of(patches, patch_numbers, target[c]));
    if (similarity < args->ncc_min) continue;
    target[similar] = target[c];
    ncc[similar++] = similarity;
    best = fmax(best, similarity);
  }
  int kept = 0;
  for (int c = 0; c < similar; ++c) {
    if (ncc[c] < args->ncc_nearly_best * best) continue;
    target[kept] = target[c];
    ncc[kept++] = ncc[c];
  }
  return kept;
}

DEFINE_COUNT_GROUPS(count_groups, private)

// LONG: a row from the index to its quad, all of it in private memory.
IN_VECTORS
kernel void temporal_match(const TemporalMatchArguments args, global const float* predicted,
                           global const float* left_points, global const int* left_cells,
                           global const float* right_points, global const int* right_cells,
                           global const char* base_left_patches, global const int* base_left_index,
                           global const char* base_right_patches, global const char* left_patches,
                           global const int* left_index, global const char* right_patches, global const float* current,
                           global int* result) {
  const int row = (int)get_global_id(0);
  if (row >= args.rows) return;
  const int i = row * args.row_step;
  int left_target[MOST], right_target[MOST];
  float left_ncc[MOST], right_ncc[MOST];
  const float3 left_predicted = edge_at(args.left_predicted, predicted, i),
               right_predicted = edge_at(args.right_predicted, predicted, i);
  const PointIndex left_points_index = open_index(args.left_index, left_points, left_cells),
                   right_points_index = open_index(args.right_index, right_points, right_cells);
  const int left =
      similar_near(&args, left_predicted, &left_points_index, patch_of(base_left_patches, base_left_index, i),
                   left_patches, left_index, left_target, left_ncc);
  const int right = similar_near(&args, right_predicted, &right_points_index, patch_of(base_right_patches, 0, i),
                                 right_patches, 0, right_target, right_ncc);
  const int flags =
      (left > 0 ? kLeftAlive : 0) | (right > 0 ? kRightAlive : 0) | (left < 0 || right < 0 ? kRowOverflow : 0);
  int agreeing = 0, winner = -1;
  float highest = 0.0f, score = 0.0f;
  for (int c = 0; c < left; ++c) {
    int found = -1;
    for (int d = 0; d < right && found < 0; ++d) {
      if (right_target[d] == left_target[c]) found = d;
    }
    if (found < 0) continue;
    const int j = left_target[c];
    const float mean = 0.5f * (left_ncc[c] + right_ncc[found]);
    const float3 edge = edge_at(args.current, current, j);
    const float dx = edge.x - left_predicted.x, dy = edge.y - left_predicted.y;
    const float weighed = mean - args.choice.distance_weight * (dx * dx + dy * dy);
    left_target[agreeing++] = j;
    if (winner >= 0 && weighed <= highest) continue;
    winner = j;
    highest = weighed;
    score = mean;
  }
  int label[MOST];
  for (int c = 0; c < agreeing; ++c) label[c] = c;
  const int groups = count_groups(0, agreeing, left_target, args.current, current, &args.choice, label);
  ((global int4*)result)[row] = (int4)(winner, groups - 1, as_int(score), flags);
}
