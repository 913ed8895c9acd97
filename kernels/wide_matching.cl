// wide_matching.cl: finds every row's edge among all columns, anywhere in the image, by its wide descriptor.
//
// Rows are every row_step-th stereo edge of the earlier rig, columns every column_step-th one of the current rig; edges
// packed as stereo_collect writes them (left x, y). The similarity of two descriptors of norm 512 is their product,
// their squared distance 2 (512^2 - product): whole numbers below 2^24, exact in single precision in any order.
// Out per row: the column with the highest similarity, the first on a tie, or -1 where
//   - another row farther than `neighbourhood` px from this one is at least as similar to that column, or
//   - a column farther than `neighbourhood` px from it has less than 1 / ratio times its distance (Lowe's test against
//   a match elsewhere).
// One work-item = one row. Reference: host/reference/wide_matching.cpp.

#define BLOCKS (kWideBytes / 16)
#define SQUARE 262144.0f  // 512^2

typedef struct {
  float16 part[BLOCKS];
} Descriptor;

static inline Descriptor wide_load(global const uchar* bytes) {
  Descriptor result;
  for (int k = 0; k < BLOCKS; ++k) result.part[k] = convert_float16(((global const uchar16*)bytes)[k]);
  return result;
}

static inline float wide_product(const Descriptor* a, global const uchar* b) {
  float16 sum = 0.0f;
  for (int k = 0; k < BLOCKS; ++k) sum = fma(a->part[k], convert_float16(((global const uchar16*)b)[k]), sum);
  const float8 eight = sum.lo + sum.hi;
  const float4 four = eight.lo + eight.hi;
  const float2 two = four.lo + four.hi;
  return two.x + two.y;
}

static inline bool wide_apart(global const float* x, global const float* y, const int i, const int j,
                              const float distance) {
  const float dx = x[i] - x[j], dy = y[i] - y[j];
  return dx * dx + dy * dy > distance * distance;
}

kernel void wide_match(const WideMatchingArguments args, global const uchar* row_descriptors,
                       global const float* row_edges, global const uchar* column_descriptors,
                       global const float* column_edges, global int* best, global float* similarity) {
  const int rows = args.rows.count, row_step = args.rows.step, row_stride = args.rows.stride;
  const int columns = args.columns.count, column_step = args.columns.step, column_stride = args.columns.stride;
  const float neighbourhood = args.neighbourhood, ratio = args.ratio;
  const int row = (int)get_global_id(0);
  if (row >= rows) return;
  best[row] = -1;
  similarity[row] = 0.0f;
  const Descriptor mine = wide_load(row_descriptors + (size_t)row * kWideBytes);
  int winner = -1;
  float highest = 0.0f;
  for (int column = 0; column < columns; ++column) {
    const float product = wide_product(&mine, column_descriptors + (size_t)column * kWideBytes);
    winner = product > highest ? column : winner;
    highest = max(product, highest);
  }
  if (winner < 0) return;
  const Descriptor found = wide_load(column_descriptors + (size_t)winner * kWideBytes);
  for (int other = 0; other < rows; ++other) {
    if (!wide_apart(row_edges, row_edges + row_stride, other * row_step, row * row_step, neighbourhood)) continue;
    if (wide_product(&found, row_descriptors + (size_t)other * kWideBytes) >= highest) return;
  }
  const float limit =
      SQUARE - (SQUARE - highest) / (ratio * ratio);  // similarity from which a match elsewhere is too good
  for (int column = 0; column < columns; ++column) {
    if (!wide_apart(column_edges, column_edges + column_stride, column * column_step, winner * column_step,
                    neighbourhood))
      continue;
    if (wide_product(&mine, column_descriptors + (size_t)column * kWideBytes) > limit) return;
  }
  best[row] = winner;
  similarity[row] = highest / SQUARE;
}
