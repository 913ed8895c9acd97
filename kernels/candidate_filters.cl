// candidate_filters.cl: NCC, SIFT and both best-and-nearly-best filters over candidate lists, in stereo and in time.
//
// Needs similarity.cl. In: candidate lists; patches and SIFT descriptors of both sets of edges, with the numbers under which an
// edge's own stand there.
// Out per candidate: NCC, SIFT distance, and `rejected_by`, the order of the filter that rejected it (0: alive);
// per row the number of survivors.
// One work-item = one row. Row r belongs to edge r * row_step of the first set.
// sift_max = 0: SIFT takes no part.
// Orders: FIRST_ORDER + 0 SIFT or NCC (the cascade's own order), + 1 the other, + 2 nearly best NCC, + 3 nearly best SIFT.
// Reference: host/reference/candidate_filters.cpp.

kernel void candidate_filters(global const int* first, global const int* target, const int rows, const int row_step,
                              const int capacity, global const char* patches_a, global const int* patch_of_a,
                              global const uchar* sift_a, global const int* sift_of_a, global const char* patches_b,
                              global const int* patch_of_b, global const uchar* sift_b, global const int* sift_of_b,
                              const float ncc_min, const float sift_max, const float ncc_nearly_best,
                              const float sift_nearly_best, const int ncc_order, const int sift_order,
                              const int all_scores, global float* ncc, global float* sift, global uchar* rejected_by,
                              global int* alive) {
  const int row = (int)get_global_id(0);
  if (row >= rows) return;
  const int begin = first[row], end = min(first[row + 1], capacity);
  global const char* patch = patches_a + PATCH_BYTES * (size_t)patch_of_a[row * row_step];
  global const uchar* descriptor = sift_a + EDGE_BYTES * (size_t)sift_of_a[row * row_step];

  // Which of the two similarities is computed first does not change who survives; only a tap needs both for all.
  float best_ncc = 0.0f;
  for (int c = begin; c < end; ++c) {
    const int j = target[c];
    const float similarity = patch_ncc(patch, patches_b + PATCH_BYTES * (size_t)patch_of_b[j]);
    const int ncc_fails = similarity < ncc_min;
    int sift_fails = 0;
    float distance = 0.0f;
    if (all_scores || (!ncc_fails && sift_max > 0.0f)) {
      distance = sqrt((float)sift_distance2(descriptor, sift_b + EDGE_BYTES * (size_t)sift_of_b[j]));
      sift_fails = sift_max > 0.0f && distance > sift_max;
    }
    ncc[c] = similarity;
    sift[c] = distance;
    int state = 0;
    if (ncc_fails && sift_fails)
      state = min(ncc_order, sift_order);
    else if (ncc_fails)
      state = ncc_order;
    else if (sift_fails)
      state = sift_order;
    rejected_by[c] = (uchar)state;
    if (state == 0) best_ncc = fmax(best_ncc, similarity);
  }
  const int nearly_best_order = max(ncc_order, sift_order) + 1;
  float best_sift = INFINITY;
  for (int c = begin; c < end; ++c) {
    if (rejected_by[c] != 0) continue;
    if (ncc[c] < ncc_nearly_best * best_ncc)
      rejected_by[c] = (uchar)nearly_best_order;
    else
      best_sift = fmin(best_sift, sift[c]);
  }
  int survivors = 0;
  for (int c = begin; c < end; ++c) {
    if (rejected_by[c] == 0 && sift_max > 0.0f && sift_nearly_best * sift[c] > best_sift)
      rejected_by[c] = (uchar)(nearly_best_order + 1);
    if (rejected_by[c] == 0) ++survivors;
  }
  alive[row] = survivors;
}
