// temporal_match_groups.cl: temporal_match.cl with one work-group of GROUP work-items per row, for GPUs. Candidates are
// kept in local memory, GROUP points of the index are tested at a time, and eight work-items share a pair of patches.
//
// Needs similarity_lanes.cl, edge_groups.cl and indexed_points.cl. In and out as in
// temporal_match.cl, and the same bits: what work-items add up are whole numbers.
// GROUP is at most 32, so that one word holds a bit per work-item.
// Reference: host/workbench/reference/temporal_matching.cpp.

// Maximum number of candidates per row and side; rows with more are flagged and have no result.
#define MOST 160
#define PAIRS (GROUP / PAIR_ITEMS)
#define NOBODY (-1)  // the target of a candidate that a filter has rejected

// Votes of all work-items, one bit each. Three words are used in turn, so that one barrier per vote suffices: before a
// word is cleared, all work-items have passed the barrier of the following vote and thus have read it.
typedef struct {
  local uint* words;
  int turn;
} Votes;

static inline uint vote(Votes* votes, const int yes) {
  const int item = (int)get_local_id(0), now = votes->turn, next = now == 2 ? 0 : now + 1;
  if (item == 0) votes->words[next] = 0;
  if (yes) atomic_or(votes->words + now, 1u << (uint)item);
  barrier(CLK_LOCAL_MEM_FENCE);
  votes->turn = next;
  return votes->words[now];
}

// Number of work-items before this one that voted yes.
static inline int voters_before(const uint word) { return (int)popcount(word & ((1u << (uint)get_local_id(0)) - 1u)); }

// The candidates of one side of a row, in the order of the index.
typedef struct {
  int target[MOST];
  float ncc[MOST];
} Candidates;

// One side of a row: what is searched, and where.
typedef struct {
  float3 predicted;
  PointIndex index;
  global const char* patch;    // of the base's stereo edge
  global const char* patches;  // of the current edges
  global const int* numbers;   // of the current stereo edges' patches; 0: those of the stereo edges
} RowSide;

// Points of the index within the radius and the turn. Returns their number; beyond MOST there is no room.
static inline int find_near(const float radius, const float orientation, RowSide* side, local Candidates* found,
                            Votes* votes) {
  const PointIndex* index = &side->index;
  const float3 predicted = side->predicted;
  const int there = isfinite(predicted.x) && isfinite(predicted.y) && isfinite(predicted.z);
  const float x = there ? predicted.x : 0.0f, y = there ? predicted.y : 0.0f;
  const int columns = index->columns, rows = index->rows;
  const int first_column = cell_of(x - radius, kCellWidth, columns),
            last_column = cell_of(x + radius, kCellWidth, columns);
  const int last_row = there ? cell_of(y + radius, kCellHeight, rows) : -1;
  int near = 0, row = cell_of(y - radius, kCellHeight, rows) - 1, begin = 0, end = 0;
  for (;;) {  // one loop over all rows of cells: PoCL compiles barriers in nested loops slowly
    while (begin >= end && row < last_row) {
      ++row;
      begin = index->cell_first[row * columns + first_column];
      end = index->cell_first[row * columns + last_column + 1];
    }
    if (begin >= end) break;
    const int k = begin + (int)get_local_id(0);
    int passes = 0;
    if (k < end) {
      const float dx = index->x[k] - x, dy = index->y[k] - y;
      passes = dx * dx + dy * dy <= radius * radius && angle_between(index->direction[k], predicted.z) <= orientation;
    }
    const uint passing = vote(votes, passes);
    const int slot = near + voters_before(passing);
    if (passes && slot < MOST) found->target[slot] = index->number[k];
    near += (int)popcount(passing);
    begin += GROUP;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  return near;
}

// NCC with the patches of all candidates: patch_ncc() bit by bit.
static inline void compare_patches(const RowSide* side, const int count, local Candidates* found,
                                   local int4* products) {
  const int item = (int)get_local_id(0), row = item % PAIR_ITEMS;
  const char16 mine = row < kPatchRows ? patch_row(side->patch, row) : (char16)0;
  const float2 inverse_a = patch_norms(side->patch);
  for (int first = 0; first < count; first += PAIRS) {
    const int c = first + item / PAIR_ITEMS;
    global const char* other = patch_of(side->patches, side->numbers, found->target[min(c, count - 1)]);
    products[item] = row_products(mine, patch_row(other, row));
    barrier(CLK_LOCAL_MEM_FENCE);
    if (row == 0 && c < count) {
      const float2 inverse_b = patch_norms(other);
      const float4 scores = convert_float4(sum_of_items(products + item, kPatchRows)) * inverse_a.xyxy * inverse_b.xyyx;
      found->ncc[c] = max(max(scores.x, scores.y), max(scores.z, scores.w));
    }
    barrier(CLK_LOCAL_MEM_FENCE);
  }
}

// Rejects the candidates that are not similar enough, or not nearly as similar as the best. Returns whether the
// work-item has found one that is.
static inline int keep_similar(const TemporalMatchArguments* args, const int count, local Candidates* found) {
  float best = 0.0f;
  for (int c = 0; c < count; ++c) best = fmax(best, found->ncc[c]);
  const float least = args->ncc_nearly_best * best;
  int alive = 0;
  for (int c = (int)get_local_id(0); c < count; c += GROUP) {
    const float ncc = found->ncc[c];
    const int passes = !(ncc < args->ncc_min) && !(ncc < least);
    if (!passes) found->target[c] = NOBODY;
    alive |= passes;
  }
  return alive;
}

// Rejects the left candidates that are no right candidates; the others take the mean of both similarities.
static inline void keep_agreeing(const int left_count, const int right_count, local Candidates* left,
                                 local const Candidates* right) {
  for (int c = (int)get_local_id(0); c < left_count; c += GROUP) {
    const int target = left->target[c];
    if (target == NOBODY) continue;
    int d = 0;
    while (d < right_count && right->target[d] != target) ++d;
    if (d < right_count) {
      left->ncc[c] = 0.5f * (left->ncc[c] + right->ncc[d]);
    } else {
      left->target[c] = NOBODY;
    }
  }
}

// count_groups() by all work-items: the lowest number of a group spreads from one half of `labels` to the other.
static inline int count_groups_together(const TemporalMatchArguments* args, local const int* edges, const int count,
                                        global const float* current, local int* labels, Votes* votes) {
  const int item = (int)get_local_id(0);
  for (int c = item; c < count; c += GROUP) labels[c] = c;
  barrier(CLK_LOCAL_MEM_FENCE);
  int turn = 0, moving;
  do {
    local const int* now = labels + turn * MOST;
    local int* next = labels + (1 - turn) * MOST;
    int moves = 0;
    for (int c = item; c < count; c += GROUP) {
      int lowest = now[c];
      for (int d = 0; d < count; ++d) {
        if (now[d] < lowest && are_chained(args->current, current, edges[c], edges[d], &args->choice)) lowest = now[d];
      }
      moves |= lowest < now[c];
      next[c] = lowest;
    }
    moving = vote(votes, moves) != 0;
    turn = 1 - turn;
  } while (moving);
  int groups = 0;
  for (int c = 0; c < count; ++c) groups += labels[turn * MOST + c] == c;
  return groups;
}

// LONG: a row from the index to its quad, all of it in local memory.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void temporal_match(
    const TemporalMatchArguments args, global const float* predicted, global const float* left_points,
    global const int* left_cells, global const float* right_points, global const int* right_cells,
    global const char* base_left_patches, global const int* base_left_index, global const char* base_right_patches,
    global const char* left_patches, global const int* left_index, global const char* right_patches,
    global const float* current, global int* result) {
  local Candidates candidates[2];
  local int4 products[GROUP];
  local uint words[3];
  Votes votes = {words, 0};
  const int row = (int)get_group_id(0), item = (int)get_local_id(0);
  const int i = row * args.row_step;
  if (item == 0) words[0] = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  int flags = 0, count = 0, right_count = 0;
  RowSide side;
#pragma unroll 1  // one copy of the filters: registers
  for (int right = 1; right >= 0; --right) {
    side.predicted = edge_at(right ? args.right_predicted : args.left_predicted, predicted, i);
    side.index = open_index(right ? args.right_index : args.left_index, right ? right_points : left_points,
                            right ? right_cells : left_cells);
    side.patch = right ? patch_of(base_right_patches, 0, i) : patch_of(base_left_patches, base_left_index, i);
    side.patches = right ? right_patches : left_patches;
    side.numbers = right ? 0 : left_index;
    local Candidates* found = candidates + right;
    const int near = find_near(args.radius, args.orientation, &side, found, &votes);
    if (near > MOST) flags |= kRowOverflow;
    count = near > MOST ? 0 : near;
    compare_patches(&side, count, found, products);
    if (vote(&votes, keep_similar(&args, count, found)) != 0) flags |= right ? kRightAlive : kLeftAlive;
    if (right) right_count = count;
  }
  local Candidates *left = candidates, *right = candidates + 1;
  keep_agreeing(count, right_count, left, right);
  barrier(CLK_LOCAL_MEM_FENCE);

  const float3 wanted = edge_at(args.left_predicted, predicted, i);
  int agreeing = 0, winner = -1;
  float highest = 0.0f, score = 0.0f;
  for (int c = 0; c < count; ++c) {
    const int j = left->target[c];
    if (j == NOBODY) continue;
    if (item == 0) right->target[agreeing] = j;  // the right candidates have served
    ++agreeing;
    const float3 edge = edge_at(args.current, current, j);
    const float dx = edge.x - wanted.x, dy = edge.y - wanted.y;
    const float weighed = left->ncc[c] - args.choice.distance_weight * (dx * dx + dy * dy);
    if (winner >= 0 && weighed <= highest) continue;
    winner = j;
    highest = weighed;
    score = left->ncc[c];
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  local int labels[2 * MOST];
  const int groups = count_groups_together(&args, right->target, agreeing, current, labels, &votes);
  if (item == 0) ((global int4*)result)[row] = (int4)(winner, groups - 1, as_int(score), flags);
}
