// scan.cl: exclusive prefix sums of int counts, cut at a capacity.
//
// In: counts (count). Out: first (count + 1) with first[i] = min(counts[0] + ... + counts[i - 1], capacity), and
// total = {elements that fit, elements that were cut off}. Every group owns one contiguous part of the counts, every
// work-item one contiguous part of its group's. Two launches over the same groups: scan_sums, then scan_write; with one
// group the first may be left out. Integer sums, so the result does not depend on the sizes chosen.
#ifndef SCAN_LOCAL
#define SCAN_LOCAL 1
#endif

// Sum of the work-item's part, and where the part lies.
static inline int part_sum(global const int* counts, const int count, int* begin, int* end) {
  const int items = (int)get_num_groups(0) * SCAN_LOCAL;
  const int part = (count + items - 1) / items;
  *begin = min((int)get_global_id(0) * part, count);
  *end = min(*begin + part, count);
  int sum = 0;
  for (int i = *begin; i < *end; ++i) sum += counts[i];
  return sum;
}

// Inclusive sums over the work-items of the group.
static inline int group_scan(int value, local int* sums) {
  const int item = (int)get_local_id(0);
  sums[item] = value;
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int step = 1; step < SCAN_LOCAL; step *= 2) {
    const int other = item >= step ? sums[item - step] : 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    sums[item] += other;
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  return sums[item];
}

kernel void scan_sums(global const int* counts, const int count, global int* group_sums) {
  local int sums[SCAN_LOCAL];
  int begin, end;
  const int inclusive = group_scan(part_sum(counts, count, &begin, &end), sums);
  if (get_local_id(0) == SCAN_LOCAL - 1) group_sums[get_group_id(0)] = inclusive;
}

kernel void scan_write(global const int* counts, const int count, global const int* group_sums, const int capacity,
                       global int* first, global int* total) {
  local int sums[SCAN_LOCAL];
  int begin, end;
  const int own = part_sum(counts, count, &begin, &end);
  int sum = group_scan(own, sums) - own;
  for (int group = 0; group < (int)get_group_id(0); ++group) sum += group_sums[group];
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
