// global_matching_tiles.cl: global_matching.cl with a group of GROUP work-items per ROWS rows, for GPUs. A group reads
// the descriptors of GROUP columns at a time into local memory, one after the other; each work-item has a column of its
// own and compares it with all the rows of the group.
//
// In and out as in global_matching.cl, and the same bits: products are whole numbers.
// Reference: host/workbench/reference/temporal_matching.cpp.

#define WORDS (kWideBytes / 4)
#define PITCH (WORDS + 1)  // words between columns in local memory: work-items meet different banks
#define SQUARE 262144      // 512^2

static inline int global_apart(const float ax, const float ay, const float bx, const float by, const float distance) {
  const float dx = ax - bx, dy = ay - by;
  return dx * dx + dy * dy > distance * distance;
}

static inline int word_product(const uint a, const uint b) {
  return (int)((a & 255u) * (b & 255u) + (a >> 8u & 255u) * (b >> 8u & 255u) + (a >> 16u & 255u) * (b >> 16u & 255u) +
               (a >> 24u) * (b >> 24u));
}

// Reads `count` descriptors from number `first` on into local memory, coalesced.
static inline void load_tile(global const uint* descriptors, const int first, const int count, local uint* tile) {
  for (int k = (int)get_local_id(0); k < count * WORDS; k += GROUP)
    tile[k / WORDS * PITCH + k % WORDS] = descriptors[(size_t)first * WORDS + k];
}

// Products of the work-item's descriptor with ROWS others.
static inline void multiply(local const uint* mine, local const uint* others, int* product) {
#pragma unroll
  for (int r = 0; r < ROWS; ++r) product[r] = 0;
#pragma unroll 4
  for (int word = 0; word < WORDS; ++word) {
    const uint of_mine = mine[word];
#pragma unroll
    for (int r = 0; r < ROWS; ++r) product[r] += word_product(of_mine, others[r * PITCH + word]);
  }
}

// LONG: three walks over descriptors that share their tiles.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void global_match(
    const GlobalMatchingArguments args, global const uchar* row_descriptors, global const float* row_edges,
    global const uchar* column_descriptors, global const float* column_edges, global int* best,
    global float* similarity) {
  local uint tile[GROUP * PITCH], mine[ROWS * PITCH], found[ROWS * PITCH];
  local int highest[ROWS], winner[ROWS], beaten[ROWS];
  const int item = (int)get_local_id(0), first_row = (int)get_group_id(0) * ROWS;
  const int rows = args.rows.count, columns = args.columns.count, row_count = min(ROWS, rows - first_row);
  global const uint* row_words = (global const uint*)row_descriptors;
  global const uint* column_words = (global const uint*)column_descriptors;
  global const float *row_x = row_edges, *row_y = row_edges + args.rows.stride;
  global const float *column_x = column_edges, *column_y = column_edges + args.columns.stride;
  for (int k = item; k < ROWS * PITCH; k += GROUP) mine[k] = found[k] = 0;  // rows beyond the last are similar to none
  barrier(CLK_LOCAL_MEM_FENCE);
  load_tile(row_words, first_row, row_count, mine);

  int product[ROWS], most[ROWS], at[ROWS];
#pragma unroll
  for (int r = 0; r < ROWS; ++r) {
    most[r] = 0;
    at[r] = -1;
  }
  for (int from = 0; from < columns; from += GROUP) {
    const int count = min(GROUP, columns - from);
    load_tile(column_words, from, count, tile);
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < count) {
      multiply(tile + item * PITCH, mine, product);
#pragma unroll
      for (int r = 0; r < ROWS; ++r) {
        at[r] = product[r] > most[r] ? from + item : at[r];
        most[r] = max(product[r], most[r]);
      }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  // The tile has served for now; its memory holds what every work-item found.
  local int *highest_of = (local int*)tile, *winner_of = highest_of + ROWS * GROUP;
#pragma unroll
  for (int r = 0; r < ROWS; ++r) {
    highest_of[r * GROUP + item] = most[r];
    winner_of[r * GROUP + item] = at[r];
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item < ROWS) {  // the first of the most similar columns
    int high = 0, column = -1;
    for (int k = 0; k < GROUP; ++k) {
      const int of_k = highest_of[item * GROUP + k], column_of_k = winner_of[item * GROUP + k];
      if (of_k > high || (of_k == high && column_of_k >= 0 && column_of_k < column)) {
        high = of_k;
        column = column_of_k;
      }
    }
    highest[item] = high;
    winner[item] = column;
    beaten[item] = item >= row_count || column < 0;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int r = 0; r < row_count; ++r)
    if (winner[r] >= 0) load_tile(column_words, winner[r], 1, found + r * PITCH);
  barrier(CLK_LOCAL_MEM_FENCE);

  for (int from = 0; from < rows; from += GROUP) {  // another row that is at least as similar to the column
    const int count = min(GROUP, rows - from);
    load_tile(row_words, from, count, tile);
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < count) {
      multiply(tile + item * PITCH, found, product);
      const int other = (from + item) * args.rows.step;
#pragma unroll
      for (int r = 0; r < ROWS; ++r) {
        const int row = min(first_row + r, rows - 1) * args.rows.step;
        if (product[r] >= highest[r] &&
            global_apart(row_x[other], row_y[other], row_x[row], row_y[row], args.neighbourhood))
          atomic_or(beaten + r, 1);
      }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  for (int from = 0; from < columns; from += GROUP) {  // a column elsewhere whose similarity is too close
    const int count = min(GROUP, columns - from);
    load_tile(column_words, from, count, tile);
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < count) {
      multiply(tile + item * PITCH, mine, product);
      const int column = (from + item) * args.columns.step;
#pragma unroll
      for (int r = 0; r < ROWS; ++r) {
        const float limit = (float)SQUARE - ((float)SQUARE - (float)highest[r]) / (args.ratio * args.ratio);
        const int of_winner = max(winner[r], 0) * args.columns.step;
        if ((float)product[r] > limit && global_apart(column_x[column], column_y[column], column_x[of_winner],
                                                      column_y[of_winner], args.neighbourhood))
          atomic_or(beaten + r, 1);
      }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  if (item < row_count) {
    best[first_row + item] = beaten[item] ? -1 : winner[item];
    similarity[first_row + item] = beaten[item] ? 0.0f : (float)highest[item] / (float)SQUARE;
  }
}
