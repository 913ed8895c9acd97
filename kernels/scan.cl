// scan.cl: exclusive prefix sums of int counts, cut at a capacity.
//
// In: counts (count). Out: first (count + 1) with first[i] = min(counts[0] + ... + counts[i - 1], capacity), and
// total = {elements that fit, elements that were cut off}. Every group owns one contiguous part of the counts, every
// work-item one contiguous part of its group's. In OpenCL 1.2 groups cannot wait for each other, so every group
// sums all counts before its part itself, and one launch suffices: with 32 groups every count is read 16 times more, in
// order. The sums are integers, so the result does not depend on the sizes.
#ifndef SCAN_LOCAL
#define SCAN_LOCAL 1
#endif

// Inclusive sums over the work-items of the group, for all of them.
static inline void group_scan(local int2* sums) {
  const int item = (int)get_local_id(0);
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int step = 1; step < SCAN_LOCAL; step *= 2) {
    const int2 other = item >= step ? sums[item - step] : (int2)(0);
    barrier(CLK_LOCAL_MEM_FENCE);
    sums[item] += other;
    barrier(CLK_LOCAL_MEM_FENCE);
  }
}

kernel __attribute__((reqd_work_group_size(SCAN_LOCAL, 1, 1))) void scan(global const int* counts, const int count,
                                                                         const int capacity, global int* first,
                                                                         global int* total) {
  local int2 sums[SCAN_LOCAL];  // sums before and within the group's part
  const int item = (int)get_local_id(0);
  const int part = (count + (int)get_global_size(0) - 1) / (int)get_global_size(0);
  const int group_begin = min((int)get_group_id(0) * SCAN_LOCAL * part, count);
  const int begin = min((int)get_global_id(0) * part, count), end = min(begin + part, count);
  int before = 0, own = 0;
  for (int i = item; i < group_begin; i += SCAN_LOCAL) before += counts[i];
  for (int i = begin; i < end; ++i) own += counts[i];
  sums[item] = (int2)(before, own);
  group_scan(sums);
  int sum = sums[SCAN_LOCAL - 1].x + sums[item].y - own;
  for (int i = begin; i < end; ++i) {
    first[i] = min(sum, capacity);
    sum += counts[i];
  }
  if (get_global_id(0) == get_global_size(0) - 1) {
    first[count] = min(sum, capacity);
    total[0] = min(sum, capacity);
    total[1] = sum - min(sum, capacity);
  }
}
