// candidate_filters_groups.cl: candidate_filters.cl with one work-group of GROUP work-items per row, for GPUs. Eight
// work-items share a candidate, so that they read its patches and descriptors from contiguous memory.
//
// Needs similarity_lanes.cl. Input, output and bits are those of candidate_filters.cl, since all sums are integers.
// Reference: host/workbench/reference/candidates.cpp.

#define PAIRS (GROUP / PAIR_ITEMS)

// The state of a candidate after both limits.
static inline int judge(const FilterLimits* limits, const float similarity, const float distance) {
  const int ncc_fails = similarity < limits->ncc_min;
  const int sift_fails = limits->sift_max > 0.0f && distance > limits->sift_max;
  if (ncc_fails && sift_fails) return min(limits->ncc_order, limits->sift_order);
  return ncc_fails ? limits->ncc_order : sift_fails ? limits->sift_order : kCandidateAlive;
}

// LONG: a row through four filters.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void candidate_filters(
    const FilterArguments args, global const int* first, global const int* target, global const char* patches_a,
    global const int* patch_of_a, global const uchar* sift_a, global const char* patches_b,
    global const int* patch_of_b, global const uchar* sift_b, global float* ncc, global float* sift,
    global uchar* state, global int* alive) {
  local int4 products[GROUP], distances[GROUP];
  local float best[GROUP];
  local int survivors[GROUP];
  const int row = (int)get_group_id(0), item = (int)get_local_id(0), block = item % PAIR_ITEMS;
  const FilterLimits limits = args.limits;
  const int edge = row * args.row_step;
  const int begin = first[row], end = min(first[row + 1], args.capacity);
  global const char* patch = patches_a + kEdgePatchBytes * (size_t)patch_of_a[edge];
  global const uchar* descriptor = sift_a + kEdgeSiftBytes * (size_t)edge;
  const char16 mine = block < kPatchRows ? patch_row(patch, block) : (char16)0;
  const float2 inverse_a = patch_norms(patch);
  const int with_sift = args.all_scores || limits.sift_max > 0.0f;
  float best_ncc = 0.0f;
  for (int from = begin; from < end; from += PAIRS) {
    const int c = from + item / PAIR_ITEMS, j = target[min(c, end - 1)];
    global const char* other = patches_b + kEdgePatchBytes * (size_t)patch_of_b[j];
    products[item] = row_products(mine, patch_row(other, block));
    if (with_sift) distances[item] = block_distances(descriptor, sift_b + kEdgeSiftBytes * (size_t)j, block);
    barrier(CLK_LOCAL_MEM_FENCE);
    if (block == 0 && c < end) {
      const float2 inverse_b = patch_norms(other);
      const float4 scores = convert_float4(sum_of_items(products + item, kPatchRows)) * inverse_a.xyxy * inverse_b.xyyx;
      const float similarity = max(max(scores.x, scores.y), max(scores.z, scores.w));
      float distance = 0.0f;
      if (args.all_scores || (!(similarity < limits.ncc_min) && with_sift)) {
        const int4 sums = sum_of_items(distances + item, PAIR_ITEMS);
        distance = sqrt((float)min(min(sums.x, sums.y), min(sums.z, sums.w)));
      }
      const int after = judge(&limits, similarity, distance);
      ncc[c] = similarity;
      sift[c] = distance;
      state[c] = (uchar)after;
      if (after == kCandidateAlive) best_ncc = fmax(best_ncc, similarity);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  best[item] = best_ncc;
  barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
  for (int k = 0; k < GROUP; ++k) best_ncc = fmax(best_ncc, best[k]);
  barrier(CLK_LOCAL_MEM_FENCE);

  const int nearly_best_order = max(limits.ncc_order, limits.sift_order) + 1;
  float best_sift = INFINITY;
  for (int c = begin + item; c < end; c += GROUP) {
    if (state[c] != kCandidateAlive) continue;
    if (ncc[c] < limits.ncc_nearly_best * best_ncc)
      state[c] = (uchar)nearly_best_order;
    else
      best_sift = fmin(best_sift, sift[c]);
  }
  best[item] = best_sift;
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int k = 0; k < GROUP; ++k) best_sift = fmin(best_sift, best[k]);
  int count = 0;
  for (int c = begin + item; c < end; c += GROUP) {
    if (state[c] == kCandidateAlive && limits.sift_max > 0.0f && limits.sift_nearly_best * sift[c] > best_sift)
      state[c] = (uchar)(nearly_best_order + 1);
    count += state[c] == kCandidateAlive;
  }
  survivors[item] = count;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item != 0) return;
  for (int k = 1; k < GROUP; ++k) count += survivors[k];
  alive[row] = count;
}
