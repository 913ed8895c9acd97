// candidate_filters.cl: NCC, SIFT and both best-and-nearly-best filters over candidate lists, in stereo and in time.
//
// Needs similarity.cl, for the paper's patches also paper_similarity.cl. In: candidate lists; patches of both sets of
// edges, with the patch number of every edge, and their SIFT descriptors in the order of the edges, for the paper's
// patches in that of the patches.
// Out per candidate: NCC, SIFT distance and state; per row the number of survivors. One work-item = one row.
// Reference: host/reference/candidates.cpp.

#ifndef PATCH_VALUE
#define PATCH_VALUE char
#define PATCH_VALUES kEdgePatchBytes  // of an edge
#define OPENED_PATCH global const char*
#define OPEN_PATCH(patch) (patch)
#define PATCH_NCC patch_ncc
#define DESCRIPTOR_OF(patch_of, edge) (edge)
#endif

kernel void candidate_filters(const FilterArguments args, global const int* first, global const int* target,
                              global const PATCH_VALUE* patches_a, global const int* patch_of_a,
                              global const uchar* sift_a, global const PATCH_VALUE* patches_b,
                              global const int* patch_of_b, global const uchar* sift_b, global float* ncc,
                              global float* sift, global uchar* state, global int* alive) {
  const int row = (int)get_global_id(0);
  if (row >= args.rows) return;
  const FilterLimits limits = args.limits;
  const int edge = row * args.row_step;
  const int begin = first[row], end = min(first[row + 1], args.capacity);
  const OPENED_PATCH patch = OPEN_PATCH(patches_a + PATCH_VALUES * (size_t)patch_of_a[edge]);
  global const uchar* descriptor = sift_a + kEdgeSiftBytes * (size_t)DESCRIPTOR_OF(patch_of_a, edge);

  // The order of the two filters does not change the survivors; only taps need both scores of all candidates.
  float best_ncc = 0.0f;
  for (int c = begin; c < end; ++c) {
    const int j = target[c];
    const float similarity = PATCH_NCC(patch, patches_b + PATCH_VALUES * (size_t)patch_of_b[j]);
    const int ncc_fails = similarity < limits.ncc_min;
    int sift_fails = 0;
    float distance = 0.0f;
    if (args.all_scores || (!ncc_fails && limits.sift_max > 0.0f)) {
      distance = sqrt((float)sift_distance2(descriptor, sift_b + kEdgeSiftBytes * (size_t)DESCRIPTOR_OF(patch_of_b, j)));
      sift_fails = limits.sift_max > 0.0f && distance > limits.sift_max;
    }
    ncc[c] = similarity;
    sift[c] = distance;
    int after = kCandidateAlive;
    if (ncc_fails && sift_fails)
      after = min(limits.ncc_order, limits.sift_order);
    else if (ncc_fails)
      after = limits.ncc_order;
    else if (sift_fails)
      after = limits.sift_order;
    state[c] = (uchar)after;
    if (after == kCandidateAlive) best_ncc = fmax(best_ncc, similarity);
  }
  const int nearly_best_order = max(limits.ncc_order, limits.sift_order) + 1;
  float best_sift = INFINITY;
  for (int c = begin; c < end; ++c) {
    if (state[c] != kCandidateAlive) continue;
    if (ncc[c] < limits.ncc_nearly_best * best_ncc)
      state[c] = (uchar)nearly_best_order;
    else
      best_sift = fmin(best_sift, sift[c]);
  }
  int survivors = 0;
  for (int c = begin; c < end; ++c) {
    if (state[c] == kCandidateAlive && limits.sift_max > 0.0f && limits.sift_nearly_best * sift[c] > best_sift)
      state[c] = (uchar)(nearly_best_order + 1);
    if (state[c] == kCandidateAlive) ++survivors;
  }
  alive[row] = survivors;
}
