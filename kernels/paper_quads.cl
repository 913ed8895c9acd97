// paper_quads.cl: closes the loop of the paper's method in time: a left and a right cluster of a previous stereo edge
// that hold the same current one are a quad.
//
// In: the candidate lists of both images and their clusters (paper_clusters.cl). First paper_quad_counts(), then
// paper_quads() with the scan of the counts. One work-item = one row, a previous stereo edge. Out per quad, in blocks
// of `capacity`: centres x, y [px] and direction [rad] of the left and the right cluster, mean NCC of the shared edge;
// the previous edge, the current one, and how many other quads the row has.
// Reference: close_loop() and quads_of() in host/workbench/paper/cascades.cpp.

// The clusters of a row in one image; cluster k is element first + k.
typedef struct {
  int first, count, capacity;
  global const int* member_first;
  global const int* members;
} RowClusters;

// The member of left cluster k nearest to its centre that right cluster q holds, too; -1 if there is none.
static inline int shared_member(const RowClusters* left, const int k, const RowClusters* right, const int q) {
  const int of_left = left->first + k, of_right = right->first + q;
  global const int* ours = left->members + left->member_first[of_left];
  global const int* theirs = right->members + right->member_first[of_right];
  const int our_count = left->member_first[left->capacity + of_left];
  const int their_count = right->member_first[right->capacity + of_right];
  for (int a = 0; a < our_count; ++a)
    for (int b = 0; b < their_count; ++b)
      if (ours[a] == theirs[b]) return ours[a];
  return -1;
}

kernel void paper_quad_counts(const PaperQuadArguments args, global const int* left_first, global const int* left_count,
                              global const int* left_member_first, global const int* left_members,
                              global const int* right_first, global const int* right_count,
                              global const int* right_member_first, global const int* right_members,
                              global int* counts) {
  const int row = (int)get_global_id(0);
  if (row >= args.rows) return;
  const RowClusters left = {left_first[row], left_count[row], args.left_capacity, left_member_first, left_members};
  const RowClusters right = {right_first[row], right_count[row], args.right_capacity, right_member_first,
                             right_members};
  int quads = 0;
  for (int k = 0; k < left.count; ++k)
    for (int q = 0; q < right.count; ++q) quads += shared_member(&left, k, &right, q) >= 0;
  counts[row] = quads;
}

// The NCC of a target in a row of candidates that holds it.
static inline float ncc_of(global const int* target, global const float* ncc, const int first, const int edge) {
  int c = first;
  while (target[c] != edge) ++c;
  return ncc[c];
}

kernel void paper_quads(const PaperQuadArguments args, global const int* left_first, global const int* left_count,
                        global const int* left_member_first, global const int* left_members,
                        global const float* left_clusters, global const int* left_rows, global const int* left_target,
                        global const float* left_ncc, global const int* right_first, global const int* right_count,
                        global const int* right_member_first, global const int* right_members,
                        global const float* right_clusters, global const int* right_rows,
                        global const int* right_target, global const float* right_ncc, global const int* quad_first,
                        global float* places, global int* numbers) {
  const int row = (int)get_global_id(0);
  if (row >= args.rows) return;
  const RowClusters left = {left_first[row], left_count[row], args.left_capacity, left_member_first, left_members};
  const RowClusters right = {right_first[row], right_count[row], args.right_capacity, right_member_first,
                             right_members};
  int quad = quad_first[row];
  const int others = quad_first[row + 1] - quad - 1;
  for (int k = 0; k < left.count; ++k) {
    for (int q = 0; q < right.count; ++q) {
      const int edge = shared_member(&left, k, &right, q);
      if (edge < 0) continue;
      for (int block = 0; block < 3; ++block) {
        places[block * args.capacity + quad] = left_clusters[block * left.capacity + left.first + k];
        places[(3 + block) * args.capacity + quad] = right_clusters[block * right.capacity + right.first + q];
      }
      places[6 * args.capacity + quad] = 0.5f * (ncc_of(left_target, left_ncc, left_rows[row], edge) +
                                                 ncc_of(right_target, right_ncc, right_rows[row], edge));
      numbers[quad] = row;
      numbers[args.capacity + quad] = edge;
      numbers[2 * args.capacity + quad] = others;
      ++quad;
    }
  }
}
