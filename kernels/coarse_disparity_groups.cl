// coarse_disparity_groups.cl: coarse_disparity.cl for work-groups: one group of GROUP work-items = one row or column,
// whose levels the work-items share out. Needs coarse_planes.cl. Defines: GROUP, a power of two; COLUMNS = 1.
//
// Reference: host/workbench/reference/coarse_disparity.cpp.

#ifndef GROUP
#define GROUP 64
#endif
#define STATE (kCoarseMostLevels + 2)  // costs of a path at a pixel, and one on either side of them
#define NEVER ((ushort)0x4000)         // more than a path costs

static inline void path_start(local ushort* states, const int levels) {
  for (int d = (int)get_local_id(0); d < levels + 2; d += GROUP)
    states[d] = states[STATE + d] = d == 0 || d == levels + 1 ? NEVER : (ushort)0;
  barrier(CLK_LOCAL_MEM_FENCE);
}

// One step of a path, whose costs are added to the sums. Returns the lowest of them.
static inline ushort path_step(const CoarseDisparityArguments* args, local const ushort* before, const ushort lowest,
                               global const uchar* costs, local ushort* now, local ushort* shared,
                               global ushort* sums) {
  const int lane = (int)get_local_id(0);
  ushort least = NEVER;
  for (int d = lane; d < args->levels; d += GROUP) {
    const ushort beside = (ushort)(min(before[d], before[d + 2]) + args->step_penalty);
    const ushort jump = (ushort)(lowest + args->jump_penalty);
    const ushort cost = min(min(before[d + 1], beside), jump) - lowest + costs[d];
    now[d + 1] = cost;
    sums[d] += cost;
    least = min(least, cost);
  }
  shared[lane] = least;
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int half_group = GROUP / 2; half_group > 0; half_group /= 2) {
    if (lane < half_group) shared[lane] = min(shared[lane], shared[lane + half_group]);
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  least = shared[0];
  barrier(CLK_LOCAL_MEM_FENCE);
  return least;
}

// Both paths along `count` pixels, `step` pixels apart.
static inline void both_paths(const CoarseDisparityArguments* args, global const uchar* costs, global ushort* sums,
                              const int count, const int step, local ushort* states, local ushort* shared) {
  for (int pass = 0; pass < 2; ++pass) {
    path_start(states, args->levels);
    ushort lowest = 0;
    for (int n = 0; n < count; ++n) {
      const int at = (pass == 0 ? n : count - 1 - n) * step * args->levels, parity = n & 1;
      lowest = path_step(args, states + (1 - parity) * STATE, lowest, costs + at, states + parity * STATE, shared,
                         sums + at);
    }
  }
}

// One channel of coarse_disparity.cl's costs.
static inline int channel_cost(global const uchar* own, const int stride, global const uchar* other,
                               const int other_stride) {
  const int there = max(max(own[0] - other[2 * other_stride], other[other_stride] - own[0]), 0);
  const int back = max(max(other[0] - own[2 * stride], own[stride] - other[0]), 0);
  return min(there, back);
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void coarse_rows(const CoarseDisparityArguments args,
                                                                           global const uchar* left,
                                                                           global const uchar* right,
                                                                           global uchar* costs, global ushort* sums) {
  local ushort states[2 * STATE], shared[GROUP];
  const int y = (int)get_group_id(0), levels = args.levels, stride = args.right_stride;
  costs += y * args.width * levels;
  sums += y * args.width * levels;
  for (int x = 0; x < args.width; ++x) {
    global const uchar* own = left + y * kCoarsePlanes * args.width + x;
    global const uchar* other = right + y * kCoarsePlanes * stride + args.right_first - x;
    for (int d = (int)get_local_id(0); d < levels; d += GROUP) {
      costs[x * levels + d] = (uchar)(channel_cost(own, args.width, other + d, stride) +
                                      channel_cost(own + 3 * args.width, args.width, other + 3 * stride + d, stride));
      sums[x * levels + d] = 0;
    }
  }
  both_paths(&args, costs, sums, args.width, 1, states, shared);
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void coarse_columns(const CoarseDisparityArguments args,
                                                                              global const uchar* costs,
                                                                              global ushort* sums) {
  local ushort states[2 * STATE], shared[GROUP];
  const int x = (int)get_group_id(0);
  both_paths(&args, costs + x * args.levels, sums + x * args.levels, args.height, args.width, states, shared);
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void coarse_positions(const CoarseDisparityArguments args,
                                                                                global const ushort* sums,
                                                                                global uint* lowest,
                                                                                global float* positions) {
  const int y = (int)get_group_id(0), lane = (int)get_local_id(0), levels = args.levels;
  sums += y * args.width * levels;
  lowest += y * args.right_stride;
  for (int column = lane; column < args.right_stride; column += GROUP) {
    uint least = UINT_MAX;
    for (int d = 0; d < levels; ++d) {
      const int x = args.right_first + d - column;
      if (x >= 0 && x < args.width) least = min(least, (uint)sums[x * levels + d] * kCoarseMostLevels + (uint)d);
    }
    lowest[column] = least;
  }
  barrier(CLK_GLOBAL_MEM_FENCE);
  for (int x = lane; x < args.width; x += GROUP) {
    global const ushort* own = sums + x * levels;
    uint least = UINT_MAX;
    for (int d = 0; d < levels; ++d) least = min(least, (uint)own[d] * kCoarseMostLevels + (uint)d);
    const int best = (int)(least % kCoarseMostLevels);
    positions[y * args.width + x] =
        coarse_position(&args, own, x, best, (int)(lowest[args.right_first - x + best] % kCoarseMostLevels));
  }
}
