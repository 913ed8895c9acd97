// candidate_filters.cl: NCC, SIFT and both best-and-nearly-best filters over candidate lists, in stereo and in time.
//
// Needs similarity.cl. In: candidate lists; patches of both sets of edges, with the patch number of every edge, and
// their SIFT descriptors in the order of the edges.
// Out per candidate: NCC, SIFT distance and state; per row the number of survivors. One work-item = one row. With
// KNOWN_NCC (paper_filters.cl) the NCC is there already, and descriptors are numbered as patches are.
// Reference: host/workbench/reference/candidates.cpp.

#ifdef KNOWN_NCC
#define SIMILARITY(known, a, b) ((void)(a), (void)(b), (known))
#define SIFT_NUMBER(edge, patch_number) (patch_number)
#else
#define SIMILARITY(known, a, b) patch_ncc(a, b)
#define SIFT_NUMBER(edge, patch_number) (edge)
#endif

kernel void candidate_filters(const FilterArguments args, global const int* first, global const int* target,
                              global const char* patches_a, global const int* patch_of_a, global const uchar* sift_a,
                              global const char* patches_b, global const int* patch_of_b, global const uchar* sift_b,
                              global float* ncc, global float* sift, global uchar* state, global int* alive) {
  const int row = (int)get_global_id(0);
  if (row >= args.rows) return;
  const FilterLimits limits = args.limits;
  const int edge = row * args.row_step;
  const int begin = first[row], end = min(first[row + 1], args.capacity);
  const int own = patch_of_a[edge];
  global const char* patch = patches_a + kEdgePatchBytes * (size_t)own;
  global const uchar* descriptor = sift_a + kEdgeSiftBytes * (size_t)SIFT_NUMBER(edge, own);

  // The order of the two filters does not change the survivors; only taps need both scores of all candidates.
  float best_ncc = 0.0f;
  for (int c = begin; c < end; ++c) {
    const int j = target[c], other = patch_of_b[j];
    const float similarity = SIMILARITY(ncc[c], patch, patches_b + kEdgePatchBytes * (size_t)other);
    const int ncc_fails = similarity < limits.ncc_min;
    int sift_fails = 0;
    float distance = 0.0f;
    if (args.all_scores || (!ncc_fails && limits.sift_max > 0.0f)) {
      distance = sqrt((float)sift_distance2(descriptor, sift_b + kEdgeSiftBytes * (size_t)SIFT_NUMBER(j, other)));
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
