// temporal_match.cl: the whole temporal cascade of one row in one work-item: displacement, orientation, NCC and nearly
// best NCC in both images, agreement, the best and the competing clusters. The same as
// temporal_candidates.cl, candidate_filters.cl without SIFT and temporal_quads.cl one after the other, without lists in
// global memory.
//
// Needs similarity.cl, edge_groups.cl and indexed_points.cl. In: predicted positions of the base's stereo edges in
// both current images (NaN: none), the point indices of the current stereo edges of both sides, side patches, with the
// number of each stereo edge's left patch; right patches are in the order of the stereo edges.
// Out per row, which belongs to base edge row * row_step: kQuadRowInts ints (layouts.cl).
// With LANES (16) a work-item tests as many points of the index at once, and asks for memory ahead: for CPUs.
// With TAP it also writes down every candidate within the radius, with its scores and its state (layouts.cl). The
// orders of the filters are defined with TAP.
// Reference: host/reference/temporal_match.cpp.

// Maximum number of candidates per row and side; rows with more are flagged and have no result.
#define MOST 160

// Prefetches the two cache lines of a patch on CPUs, where OpenCL's own prefetch() does nothing (PoCL).
static inline void ask_for_patch(global const char* patch) {
#if defined(__x86_64__) || defined(__aarch64__)
  __builtin_prefetch(patch);
  __builtin_prefetch(patch + 64);
#else
  (void)patch;
#endif
}

// The patches of stereo edge `edge`; patch_numbers 0: they have the numbers of the stereo edges.
static inline global const char* patch_of(global const char* patches, global const int* patch_numbers, const int edge) {
  return patches + kEdgePatchBytes * (size_t)(patch_numbers ? patch_numbers[edge] : edge);
}

#ifdef TAP
// One side of a row as a tap sees it: kTappedInts ints per candidate. SIFT distances are computed for the tap only and
// decide nothing here.
typedef struct {
  global int* seen;                // of this row
  int room;                        // candidates that fit there
  int count;                       // candidates so far
  int at[MOST];                    // where in `seen` the candidate in each slot of `target` stands
  global const uchar* descriptor;  // of the base's stereo edge
  global const uchar* descriptors;
} TappedSide;

static inline int tap_candidate(TappedSide* tap, const int edge, const int state) {
  if (tap->count < tap->room) vstore4((int4)(edge, state, 0, 0), tap->count, tap->seen);
  return tap->count++;
}
static inline void tap_state(TappedSide* tap, const int slot, const int state) {
  if (tap->at[slot] < tap->room) tap->seen[kTappedInts * tap->at[slot] + 1] = state;
}
static inline void tap_scores(TappedSide* tap, const int slot, const int edge, const float ncc) {
  if (tap->at[slot] >= tap->room) return;
  const int distance2 = sift_distance2(tap->descriptor, tap->descriptors + kEdgeSiftBytes * (size_t)edge);
  tap->seen[kTappedInts * tap->at[slot] + 2] = as_int(ncc);
  tap->seen[kTappedInts * tap->at[slot] + 3] = as_int(sqrt((float)distance2));
}
#define TAPPED(statement) statement
#define TAP_PARAMETER , TappedSide* tap
#define TAP_ARGUMENT(tap) , tap
#else
#define TAPPED(statement)
#define TAP_PARAMETER
#define TAP_ARGUMENT(tap)
#endif

// One side's candidates that pass the filters, in the order of the index. Returns their number, -1: no room.
// patch_numbers: of the stereo edges' patches; 0: those of the edges.
// LONG: a row's candidates from the index to the nearly best; they stay in private memory.
static inline int similar_near(const TemporalMatchArguments* args, const float3 predicted, const PointIndex* index,
                               global const char* patch, global const char* patches, global const int* patch_numbers,
                               int* target, float* ncc TAP_PARAMETER) {
  const float x = predicted.x, y = predicted.y, direction = predicted.z;
  if (!(isfinite(x) && isfinite(y) && isfinite(direction))) return 0;
  global const float *xs = index->x, *ys = index->y, *directions = index->direction;
  global const int *numbers = index->number, *cell_first = index->cell_first;
  const int columns = index->columns, rows = index->rows;
  const float radius = args->radius, orientation = args->orientation;
  const int first_column = cell_of(x - radius, kCellWidth, columns),
            last_column = cell_of(x + radius, kCellWidth, columns);
  const int last_row = cell_of(y + radius, kCellHeight, rows);
#ifdef LANES
  const int total = cell_first[columns * rows];
  const float16 full_turn = 2.0f * PI_F;
#endif
  int near = 0;
  for (int row = cell_of(y - radius, kCellHeight, rows); row <= last_row; ++row) {
    const int end = cell_first[row * columns + last_column + 1];
    int k = cell_first[row * columns + first_column];
#ifdef LANES
    // The same tests in the same arithmetic. Points beyond the cells are read and left out.
    for (const int last = min(end - 1, total - LANES); k <= last && near <= MOST - LANES; k += LANES) {
      const float16 dx = LOAD(xs + k) - x, dy = LOAD(ys + k) - y, turn = fabs(LOAD(directions + k) - direction);
      const int16 close = dx * dx + dy * dy <= radius * radius;
      const uint lanes = end - k < LANES ? (1u << (uint)(end - k)) - 1u : ~0u;
      const uint passing = lane_bits(close & (min(turn, full_turn - turn) <= orientation)) & lanes;
#if defined(PACKED_LANES) && !defined(TAP)
      ((packed16*)(target + near))->lanes = PACKED_LANES(as_int16(LOAD(numbers + k)), passing);
      near += (int)popcount(passing);
#else
      uint visited = passing;
      TAPPED(visited = lane_bits(close) & lanes;)
      for (; visited != 0u; visited &= visited - 1u) {
        const int lane = lowest_bit(visited), number = numbers[k + lane];
        TAPPED(const int turned = !(passing >> (uint)lane & 1u);)
        TAPPED(tap->at[near] = tap_candidate(tap, number, turned ? ORIENTATION_ORDER : kCandidateAlive);)
        TAPPED(if (turned) continue;)
        target[near++] = number;
      }
#endif
    }
#endif
    for (; k < end; ++k) {
      const float dx = xs[k] - x, dy = ys[k] - y;
      if (dx * dx + dy * dy > radius * radius) continue;
      const int turned = angle_between(directions[k], direction) > orientation;
      TAPPED(const int at = tap_candidate(tap, numbers[k], turned ? ORIENTATION_ORDER : kCandidateAlive);)
      if (turned) continue;
      if (near == MOST) return -1;
      TAPPED(tap->at[near] = at;)
      target[near++] = numbers[k];
    }
  }
#ifdef LANES
  // The patches are scattered in memory: all are prefetched before the first is used.
  for (int c = 0; c < near; ++c) ask_for_patch(patch_of(patches, patch_numbers, target[c]));
#endif
  int similar = 0;
  float best = 0.0f;
  for (int c = 0; c < near; ++c) {
    const float similarity = patch_ncc(patch, patch_of(patches, patch_numbers, target[c]));
    TAPPED(tap_scores(tap, c, target[c], similarity);)
    if (similarity < args->ncc_min) {
      TAPPED(tap_state(tap, c, NCC_ORDER);)
      continue;
    }
    TAPPED(tap->at[similar] = tap->at[c];)
    target[similar] = target[c];
    ncc[similar++] = similarity;
    best = fmax(best, similarity);
  }
  int kept = 0;
  for (int c = 0; c < similar; ++c) {
    if (ncc[c] < args->ncc_nearly_best * best) {
      TAPPED(tap_state(tap, c, NEARLY_BEST_NCC_ORDER);)
      continue;
    }
    TAPPED(tap->at[kept] = tap->at[c];)
    target[kept] = target[c];
    ncc[kept++] = ncc[c];
  }
  return kept;
}

DEFINE_COUNT_GROUPS(private)

// LONG: a row from the index to its quad, all of it in private memory.
#ifdef LANES
IN_VECTORS
#endif
kernel void temporal_match(const TemporalMatchArguments args, global const float* predicted,
                           global const float* left_points, global const int* left_cells,
                           global const float* right_points, global const int* right_cells,
                           global const char* base_left_patches, global const int* base_left_index,
                           global const char* base_right_patches, global const char* left_patches,
                           global const int* left_index, global const char* right_patches, global const float* current,
                           global int* result
#ifdef TAP
                           // Lists of both sides: row 2 r is the left one of row r, 2 r + 1 the right one. In the first
                           // of two launches capacity is 0, and only `seen_counts` is written.
                           ,
                           global const int* seen_first, const int seen_capacity, global int* seen_counts,
                           global int* seen, global const uchar* base_left_sift, global const uchar* base_right_sift,
                           global const uchar* left_sift, global const uchar* right_sift
#endif
) {
  const int row = (int)get_global_id(0);
  if (row >= args.rows) return;
  const int i = row * args.row_step;
  int left_target[MOST], right_target[MOST];
  float left_ncc[MOST], right_ncc[MOST];
#ifdef TAP
  TappedSide tapped[2];
  for (int side = 0; side < 2; ++side) {
    const int begin = seen_capacity > 0 ? seen_first[2 * row + side] : 0;
    tapped[side].seen = seen + kTappedInts * (size_t)begin;
    tapped[side].room = seen_capacity > 0 ? min(seen_first[2 * row + side + 1], seen_capacity) - begin : 0;
    tapped[side].count = 0;
    tapped[side].descriptor = (side == 0 ? base_left_sift : base_right_sift) + kEdgeSiftBytes * (size_t)i;
    tapped[side].descriptors = side == 0 ? left_sift : right_sift;
  }
#endif
  const float3 left_predicted = edge_at(args.left_predicted, predicted, i),
               right_predicted = edge_at(args.right_predicted, predicted, i);
  const PointIndex left_points_index = open_index(args.left_index, left_points, left_cells),
                   right_points_index = open_index(args.right_index, right_points, right_cells);
  const int left =
      similar_near(&args, left_predicted, &left_points_index, patch_of(base_left_patches, base_left_index, i),
                   left_patches, left_index, left_target, left_ncc TAP_ARGUMENT(&tapped[0]));
  const int right = similar_near(&args, right_predicted, &right_points_index, patch_of(base_right_patches, 0, i),
                                 right_patches, 0, right_target, right_ncc TAP_ARGUMENT(&tapped[1]));
  TAPPED(for (int side = 0; side < 2; ++side) seen_counts[2 * row + side] = tapped[side].count;)
  const int flags =
      (left > 0 ? kLeftAlive : 0) | (right > 0 ? kRightAlive : 0) | (left < 0 || right < 0 ? kRowOverflow : 0);
  int agreeing = 0, winner = -1;
  float highest = 0.0f, score = 0.0f;
  for (int c = 0; c < left; ++c) {
    int found = -1;
    for (int d = 0; d < right && found < 0; ++d) {
      if (right_target[d] == left_target[c]) found = d;
    }
    if (found < 0) {
      TAPPED(tap_state(&tapped[0], c, AGREEMENT_ORDER);)
      continue;
    }
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
