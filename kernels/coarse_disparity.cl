// coarse_disparity.cl: a disparity per 2 x 2 pixels of a rectified pair, by semi-global matching (doc/method.md
// section 3) with costs of Birchfield and Tomasi and four paths. All numbers up to the last step are integers.
//
// coarse_rows       planes of coarse_planes.cl -> costs of all levels, and the sums of both paths along a row
// coarse_columns    costs -> adds both paths along the columns to the sums
// coarse_positions  sums -> positions on the epipolar lines, where both images agree
//
// One work-item = one row; in coarse_columns COLUMNS columns. Levels lie innermost, kCoarseLanes to a vector. The
// planes of the right image are mirrored, so that counterparts of growing disparity follow one another.
// Needs coarse_planes.cl. Define: COLUMNS. Reference: host/workbench/reference/coarse_disparity.cpp.

#ifndef COLUMNS
#define COLUMNS 8
#endif
#define FRONT kCoarseLanes                                // costs in front of a path's first level
#define STATE (kCoarseMostLevels + FRONT + kCoarseLanes)  // and behind its last one
#define NEVER ((ushort)0x4000)                            // more than a path costs

// Costs of kCoarseLanes counterparts with the three planes at `other`, one channel of Birchfield and Tomasi's: how far
// a value lies outside the bounds of the other one, the smaller way.
static inline uchar16 channel_costs(const uchar16 value, const uchar16 low, const uchar16 high,
                                    global const uchar* other, const int stride) {
  const uchar16 there = vload16(0, other), there_low = vload16(0, other + stride),
                there_high = vload16(0, other + 2 * stride);
  return min(max(sub_sat(value, there_high), sub_sat(there_low, value)),
             max(sub_sat(there, high), sub_sat(low, there)));
}

static inline ushort lowest_lane(const ushort16 v) {
  const ushort8 eight = min(v.lo, v.hi);
  const ushort4 four = min(eight.lo, eight.hi);
  const ushort2 two = min(four.lo, four.hi);
  return min(two.x, two.y);
}

// One step of a path: its costs at a pixel from those at the pixel before, both between borders that cost NEVER.
// Returns the lowest of them.
static inline ushort path_step(const CoarseDisparityArguments* args, const ushort* before, const ushort lowest,
                               global const uchar* costs, ushort* now) {
  const ushort step = (ushort)args->step_penalty, jump = (ushort)(lowest + args->jump_penalty);
  ushort16 least = NEVER;
  for (int d = 0; d < args->levels; d += kCoarseLanes) {
    const ushort16 beside = min(vload16(0, before + FRONT + d - 1), vload16(0, before + FRONT + d + 1));
    const ushort16 kept = min(vload16(0, before + FRONT + d), beside + step);
    const ushort16 cost = min(kept, (ushort16)jump) - lowest + convert_ushort16(vload16(0, costs + d));
    vstore16(cost, 0, now + FRONT + d);
    least = min(least, cost);
  }
  return lowest_lane(least);
}

// A path that has not begun: its first pixel costs what it costs.
static inline void path_start(ushort* before, ushort* now, const int levels) {
  for (int d = 0; d < levels + FRONT + kCoarseLanes; d += kCoarseLanes) {
    const ushort16 value = (ushort16)(ushort)(d < FRONT || d >= levels + FRONT ? NEVER : 0);
    vstore16(value, 0, before + d);
    vstore16(value, 0, now + d);
  }
}

static inline void add_path(const ushort* now, const int levels, global ushort* sums) {
  for (int d = 0; d < levels; d += kCoarseLanes)
    vstore16(vload16(0, sums + d) + vload16(0, now + FRONT + d), 0, sums + d);
}

kernel IN_VECTORS void coarse_rows(const CoarseDisparityArguments args, global const uchar* left,
                                   global const uchar* right, global uchar* costs, global ushort* sums) {
  const int y = (int)get_global_id(0);
  if (y >= args.height) return;
  const int levels = args.levels, stride = args.right_stride;
  costs += y * args.width * levels;
  sums += y * args.width * levels;
  ushort states[2][STATE];
  path_start(states[0], states[1], levels);
  ushort lowest = 0;
  for (int x = 0; x < args.width; ++x) {
    global const uchar* own = left + y * kCoarsePlanes * args.width + x;
    const uchar16 slope = own[0], slope_low = own[args.width], slope_high = own[2 * args.width];
    const uchar16 grey = own[3 * args.width], grey_low = own[4 * args.width], grey_high = own[5 * args.width];
    global const uchar* other = right + y * kCoarsePlanes * stride + args.right_first - x;
    for (int d = 0; d < levels; d += kCoarseLanes) {
      const uchar16 cost = channel_costs(slope, slope_low, slope_high, other + d, stride) +
                           channel_costs(grey, grey_low, grey_high, other + 3 * stride + d, stride);
      vstore16(cost, 0, costs + x * levels + d);
    }
    ushort* now = states[x & 1];
    lowest = path_step(&args, states[(x + 1) & 1], lowest, costs + x * levels, now);
    for (int d = 0; d < levels; d += kCoarseLanes) vstore16(vload16(0, now + FRONT + d), 0, sums + x * levels + d);
  }
  path_start(states[0], states[1], levels);
  lowest = 0;
  for (int x = args.width - 1; x >= 0; --x) {
    ushort* now = states[x & 1];
    lowest = path_step(&args, states[(x + 1) & 1], lowest, costs + x * levels, now);
    add_path(now, levels, sums + x * levels);
  }
}

kernel IN_VECTORS void coarse_columns(const CoarseDisparityArguments args, global const uchar* costs,
                                      global ushort* sums) {
  const int begin = (int)get_global_id(0) * COLUMNS, end = min(begin + COLUMNS, args.width), levels = args.levels;
  ushort states[COLUMNS][2][STATE];
  ushort lowest[COLUMNS];
  for (int pass = 0; pass < 2; ++pass) {
    for (int x = begin; x < end; ++x) {
      path_start(states[x - begin][0], states[x - begin][1], levels);
      lowest[x - begin] = 0;
    }
    for (int step = 0; step < args.height; ++step) {
      const int y = pass == 0 ? step : args.height - 1 - step;
      for (int x = begin; x < end; ++x) {
        const int at = (y * args.width + x) * levels, n = x - begin;
        ushort* now = states[n][step & 1];
        lowest[n] = path_step(&args, states[n][(step + 1) & 1], lowest[n], costs + at, now);
        add_path(now, levels, sums + at);
      }
    }
  }
}

// Sum and level in one number: the lowest is that of the lowest sum, among equal ones of the smallest disparity.
static inline uint16 keys_at(global const ushort* sums, const int d) {
  const uint16 lanes = (uint16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  return convert_uint16(vload16(0, sums + d)) * (uint)kCoarseMostLevels + lanes + (uint)d;
}

// `lowest`: of each column of the mirrored right image, the lowest key.
kernel IN_VECTORS void coarse_positions(const CoarseDisparityArguments args, global const ushort* sums,
                                        global uint* lowest, global float* positions) {
  const int y = (int)get_global_id(0);
  if (y >= args.height) return;
  const int levels = args.levels;
  sums += y * args.width * levels;
  lowest += y * args.right_stride;
  positions += y * args.width;
  for (int x = 0; x < args.right_stride; ++x) lowest[x] = UINT_MAX;
  for (int x = 0; x < args.width; ++x) {
    global uint* column = lowest + args.right_first - x;
    for (int d = 0; d < levels; d += kCoarseLanes)
      vstore16(min(vload16(0, column + d), keys_at(sums + x * levels, d)), 0, column + d);
  }
  for (int x = 0; x < args.width; ++x) {
    global const ushort* own = sums + x * levels;
    uint16 least = UINT_MAX;
    for (int d = 0; d < levels; d += kCoarseLanes) least = min(least, keys_at(own, d));
    const uint8 eight = min(least.lo, least.hi);
    const uint4 four = min(eight.lo, eight.hi);
    const uint2 two = min(four.lo, four.hi);
    const int best = (int)(min(two.x, two.y) % kCoarseMostLevels);
    const int back = (int)(lowest[args.right_first - x + best] % kCoarseMostLevels);
    positions[x] = coarse_position(&args, own, x, best, back);
  }
}
