// global_matching.cl: finds every row's edge among all columns, anywhere in the image, by its wide descriptor. Made for
// wide vectors: sixteen descriptors at once, one per lane, against ROWS others, so no product is summed across lanes.
//
// Rows: every row_step-th stereo edge of the earlier frame; columns: every column_step-th of the current frame; edges
// packed as stereo_collect writes them (left x, y). The similarity of two descriptors of norm 512 is their product,
// their squared distance 2 (512^2 - product): whole numbers below 2^24, exact in single precision in any order.
//
// wide_transpose  In: descriptors. Out: blocks of sixteen, in pairs of bytes: bytes k and k + 1 (k even) of descriptor
//                 16 b + lane are elements (kWideBytes b + k) * 16 + 2 lane and the next; zeros after the last
//                 descriptor. One work-item = one block.
// global_match    Out per row: the column with the highest similarity, the first on a tie, or -1 where another row
//                 farther than `neighbourhood` px from this one is at least as similar to that column, or a column
//                 farther than `neighbourhood` px from it has less than 1 / ratio times its distance (Lowe's test
//                 against a match elsewhere). One work-item = ROWS rows.
// Reference: host/workbench/reference/temporal_matching.cpp.

#ifndef ROWS
#define ROWS 8
#endif
#define LISTED 64  // blocks of columns that may hold a competing match, per row
#define PAIRS_OF_BYTES (kWideBytes / 2)
#define SQUARE 262144.0f  // 512^2

kernel void wide_transpose(global const uchar* descriptors, const int count, global uchar* blocks) {
  const int block = (int)get_global_id(0);
  if (block * kBlockLanes >= count) return;
  for (int lane = 0; lane < kBlockLanes; ++lane) {
    const int descriptor = block * kBlockLanes + lane;
    for (int k = 0; k < kWideBytes; ++k) {
      blocks[(size_t)(block * kWideBytes + (k & ~1)) * kBlockLanes + 2 * lane + (k & 1)] =
          descriptor < count ? descriptors[(size_t)descriptor * kWideBytes + k] : 0;
    }
  }
}

// Pairs of bytes of sixteen descriptors, and the sums of their products with those of another, which is repeated in
// every lane. Processors that multiply and add pairs of 16 bits in one instruction are told to, because compilers do
// not see it.
#if defined(__AVX512BW__) || defined(__AVX2__)
typedef uchar Bytes32 __attribute__((ext_vector_type(32)));
typedef short Shorts32 __attribute__((ext_vector_type(32)));
#define PAIRS Shorts32
#define WIDE_PAIRS(block, pair) __builtin_convertvector(((global const Bytes32*)(block))[pair], Shorts32)
#ifdef __AVX512BW__
#define PAIR_PRODUCTS(own, pairs) as_int16(__builtin_ia32_pmaddwd512(__builtin_astype((int16)(own), Shorts32), pairs))
#else
#define PAIR_PRODUCTS(own, pairs)                                                  \
  (int16)(as_int8(__builtin_ia32_pmaddwd256(as_short16((int8)(own)), (pairs).lo)), \
          as_int8(__builtin_ia32_pmaddwd256(as_short16((int8)(own)), (pairs).hi)))
#endif
#else
#define PAIRS ushort16
#define WIDE_PAIRS(block, pair) (((global const ushort16*)(block))[pair])
#define PAIR_PRODUCTS(own, pairs) \
  (convert_int16((pairs) & (ushort)255) * ((own)&65535) + convert_int16((pairs) >> (ushort)8) * ((own) >> 16))
#endif

// The bytes in pairs of 16 bits.
static inline void wide_load(global const uchar* descriptor, int* pairs) {
  for (int k = 0; k < PAIRS_OF_BYTES; ++k) pairs[k] = descriptor[2 * k] | descriptor[2 * k + 1] << 16;
}

// Products of ROWS descriptors with the sixteen of a block.
static inline void wide_products(const int* mine, global const uchar* block, float16* products) {
  int16 sums[ROWS];
#pragma unroll
  for (int row = 0; row < ROWS; ++row) sums[row] = 0;
  for (int k = 0; k < PAIRS_OF_BYTES; ++k) {
    const PAIRS other = WIDE_PAIRS(block, k);
#pragma unroll
    for (int row = 0; row < ROWS; ++row) sums[row] += PAIR_PRODUCTS(mine[row * PAIRS_OF_BYTES + k], other);
  }
#pragma unroll
  for (int row = 0; row < ROWS; ++row) products[row] = convert_float16(sums[row]);
}

// The same of one descriptor, in CHAINS sums that do not wait for one another.
#define CHAINS 4
static inline float16 wide_product(const int* mine, global const uchar* block) {
  int16 sums[CHAINS] = {0, 0, 0, 0};
  for (int k = 0; k < PAIRS_OF_BYTES; k += CHAINS) {
#pragma unroll
    for (int chain = 0; chain < CHAINS; ++chain)
      sums[chain] += PAIR_PRODUCTS(mine[k + chain], WIDE_PAIRS(block, k + chain));
  }
  return convert_float16((sums[0] + sums[1]) + (sums[2] + sums[3]));
}

static inline float global_highest(const float16 v) {
  const float8 eight = fmax(v.lo, v.hi);
  const float4 four = fmax(eight.lo, eight.hi);
  const float2 two = fmax(four.lo, four.hi);
  return fmax(two.x, two.y);
}

// The similarity above which a match elsewhere is too close to one of `highest`.
static inline float global_limit(const float highest, const float ratio) {
  return SQUARE - (SQUARE - highest) / (ratio * ratio);
}

// Whether a descriptor of the block reaches `limit` (or exceeds it, where `above`) farther than `distance` px from edge
// `from`.
static inline bool global_elsewhere(const float16 products, const float limit, const bool above, const int block,
                                    const int count, global const float* x, global const float* y, const int step,
                                    const int from, const float distance) {
  float of_lane[kBlockLanes];
  vstore16(products, 0, of_lane);
  for (int lane = 0; lane < kBlockLanes; ++lane) {
    const int other = block * kBlockLanes + lane;
    if (other >= count || !(above ? of_lane[lane] > limit : of_lane[lane] >= limit)) continue;
    const float dx = x[other * step] - x[from], dy = y[other * step] - y[from];
    if (dx * dx + dy * dy > distance * distance) return true;
  }
  return false;
}

// LONG: a block of rows against all columns, then back; sums and winners stay in registers.
kernel void global_match(const GlobalMatchingArguments args, global const uchar* row_descriptors,
                         global const uchar* row_blocks, global const float* row_edges,
                         global const uchar* column_descriptors, global const uchar* column_blocks,
                         global const float* column_edges, global int* best, global float* similarity) {
  const int rows = args.rows.count, row_step = args.rows.step, row_stride = args.rows.stride;
  const int columns = args.columns.count, column_step = args.columns.step, column_stride = args.columns.stride;
  const float neighbourhood = args.neighbourhood, ratio = args.ratio;
  const int first = (int)get_global_id(0) * ROWS;
  if (first >= rows) return;
  int mine[ROWS * PAIRS_OF_BYTES], found[ROWS * PAIRS_OF_BYTES];
  float16 products[ROWS];
  float highest[ROWS];
  int winner[ROWS], listed[ROWS], list[ROWS][LISTED];
  float listed_highest[ROWS][LISTED];
  bool alone[ROWS];
  for (int r = 0; r < ROWS; ++r) {
    wide_load(row_descriptors + (size_t)min(first + r, rows - 1) * kWideBytes, mine + r * PAIRS_OF_BYTES);
    highest[r] = 0.0f;
    winner[r] = -1;
    listed[r] = 0;
  }
  for (int block = 0; block * kBlockLanes < columns; ++block) {
    wide_products(mine, column_blocks + (size_t)block * (kWideBytes * kBlockLanes), products);
    for (int r = 0; r < ROWS; ++r) {
      const float here = global_highest(products[r]);
      if (here > highest[r]) {
        highest[r] = here;
        float of_lane[kBlockLanes];
        vstore16(products[r], 0, of_lane);
        int lane = 0;
        while (of_lane[lane] != here) ++lane;
        winner[r] = block * kBlockLanes + lane;
      }
      // The limit only rises: whatever it has passed does not compete. A full list is cleared of that;
      // LISTED + 1 means that it is still full.
      const float limit = global_limit(highest[r], ratio);
      if (here <= limit || listed[r] > LISTED) continue;
      if (listed[r] == LISTED) {
        listed[r] = 0;
        for (int k = 0; k < LISTED; ++k) {
          if (listed_highest[r][k] <= limit) continue;
          list[r][listed[r]] = list[r][k];
          listed_highest[r][listed[r]++] = listed_highest[r][k];
        }
        if (listed[r] == LISTED) {
          listed[r] = LISTED + 1;
          continue;
        }
      }
      list[r][listed[r]] = block;
      listed_highest[r][listed[r]++] = here;
    }
  }
  // Competing columns are few. Rows that they exclude need not be compared with all other rows.
  int left = 0;
  for (int r = 0; r < ROWS; ++r) {
    const float limit = global_limit(highest[r], ratio);
    const bool all = listed[r] > LISTED;
    const int blocks = all ? (columns + kBlockLanes - 1) / kBlockLanes : listed[r];
    alone[r] = winner[r] >= 0;
    for (int k = 0; alone[r] && k < blocks; ++k) {
      const int block = all ? k : list[r][k];
      if (!all && listed_highest[r][k] <= limit) continue;
      alone[r] = !global_elsewhere(
          wide_product(mine + r * PAIRS_OF_BYTES, column_blocks + (size_t)block * (kWideBytes * kBlockLanes)), limit,
          true, block, columns, column_edges, column_edges + column_stride, column_step, winner[r] * column_step,
          neighbourhood);
    }
    left += alone[r];
    // Rows without a winner load any descriptor that exists.
    wide_load(alone[r] ? column_descriptors + (size_t)winner[r] * kWideBytes : row_descriptors,
              found + r * PAIRS_OF_BYTES);
  }
  for (int block = 0; left > 0 && block * kBlockLanes < rows; ++block) {
    wide_products(found, row_blocks + (size_t)block * (kWideBytes * kBlockLanes), products);
    for (int r = 0; r < ROWS; ++r) {
      const int row = min(first + r, rows - 1);
      if (alone[r] && global_highest(products[r]) >= highest[r]) {
        alone[r] = !global_elsewhere(products[r], highest[r], false, block, rows, row_edges, row_edges + row_stride,
                                     row_step, row * row_step, neighbourhood);
        left -= !alone[r];
      }
    }
  }
  for (int r = 0; r < ROWS && first + r < rows; ++r) {
    best[first + r] = alone[r] ? winner[r] : -1;
    similarity[first + r] = alone[r] ? highest[r] / SQUARE : 0.0f;
  }
}
