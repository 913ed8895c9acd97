// stereo_clusters.cl: filters 8c to 10 of the stereo cascade: clustering along the epipolar line, similarity of the
// representatives, best and mutual.
//
// Needs direction.cl and epipolar.cl. Cluster k of left edge i is element first[i] + k of each block of `clusters` and
// of cluster_anchor.
// Reference: host/reference/stereo_clusters.cpp.

// By what the representative of a cluster is chosen: a represented candidate comes behind every alive one.
inline float rank_in_cluster(global const uchar* state, global const float* similarity, const int c) {
  return state[c] == kCandidateRepresented ? similarity[c] - kBehindAll : similarity[c];
}

// One work-item = one left edge. Sorts its alive and represented candidates by position, cuts the row where the gap
// reaches cluster_gap, the direction differs by more than cluster_orientation, or cluster_size_max is reached. The most
// similar member represents a cluster;
// best_cluster is the most similar of those that reach similarity_min (-1: none). `order` is scratch.
kernel void stereo_clusters(const StereoClusterArguments args, global const int* first, global const int* target,
                            global const float* right_edges, global const uchar* state, global const float* position,
                            global const float* similarity, global int* order, global int* cluster_count,
                            global float* clusters, global int* cluster_anchor, global int* best_cluster) {
  const int i = (int)get_global_id(0);
  if (i >= args.left.count) return;
  global const float* right_direction = right_edges + args.right.first + 2 * args.right.stride;
  global float* cluster_position = clusters;
  global float* cluster_direction = clusters + args.capacity;
  global float* cluster_similarity = clusters + 2 * args.capacity;
  const int begin = first[i], end = min(first[i + 1], args.capacity);
  int members = 0;
  for (int c = begin; c < end; ++c) {
    if (state[c] != kCandidateAlive && state[c] != kCandidateRepresented) continue;
    int k = begin + members;
    for (; k > begin && position[order[k - 1]] > position[c]; --k) order[k] = order[k - 1];
    order[k] = c;
    ++members;
  }
  int found = 0, best = -1;
  int from = begin;
  while (from < begin + members) {
    int to = from + 1;
    while (to < begin + members && to - from < args.cluster_size_max &&
           position[order[to]] - position[order[to - 1]] < args.cluster_gap &&
           angle_between(right_direction[target[order[to]]], right_direction[target[order[to - 1]]]) <=
               args.cluster_orientation) {
      ++to;
    }
    float highest = rank_in_cluster(state, similarity, order[from]);
    for (int k = from + 1; k < to; ++k) highest = fmax(highest, rank_in_cluster(state, similarity, order[k]));
    int chosen = -1;
    for (int k = from; k < to; ++k) {
      if (rank_in_cluster(state, similarity, order[k]) >= highest - kSimilarityTie &&
          (chosen < 0 || target[order[k]] < target[chosen]))
        chosen = order[k];
    }
    const float chosen_rank = rank_in_cluster(state, similarity, chosen);
    float cosine = 0.0f, sine = 0.0f;
    for (int k = from; k < to; ++k) {
      const float distance = position[order[k]] - position[chosen];
      const float weight = exp(-0.5f * (distance / args.cluster_sigma) * (distance / args.cluster_sigma));
      float member_cosine;
      const float member_sine = sine_cosine(right_direction[target[order[k]]], &member_cosine);
      cosine += weight * member_cosine;
      sine += weight * member_sine;
    }
    const int k = begin + found;
    cluster_position[k] = position[chosen];
    cluster_direction[k] = atan2(sine, cosine);
    cluster_anchor[k] = target[chosen];
    cluster_similarity[k] = chosen_rank;
    if (chosen_rank >= args.similarity_min && (best < 0 || chosen_rank > cluster_similarity[best])) best = k;
    ++found;
    from = to;
  }
  cluster_count[i] = found;
  best_cluster[i] = best;
}

// Mutual best in three launches over the left edges. Maxima and minima of integers do not depend on the order of the
// work-items.
// 1: the highest similarity that any left edge offers to a right edge (positive floats order like their bits).
kernel void stereo_claim(const StereoClusterArguments args, global const int* best_cluster,
                         global const int* cluster_anchor, global const float* clusters, global int* claimed) {
  const int i = (int)get_global_id(0);
  if (i >= args.left.count || best_cluster[i] < 0) return;
  global const float* cluster_similarity = clusters + 2 * args.capacity;
  atomic_max(claimed + cluster_anchor[best_cluster[i]], as_int(cluster_similarity[best_cluster[i]]));
}
// 2: the first left edge that offers it.
kernel void stereo_owner(const StereoClusterArguments args, global const int* best_cluster,
                         global const int* cluster_anchor, global const float* clusters, global const int* claimed,
                         global int* owner) {
  const int i = (int)get_global_id(0);
  if (i >= args.left.count || best_cluster[i] < 0) return;
  global const float* cluster_similarity = clusters + 2 * args.capacity;
  const int anchor = cluster_anchor[best_cluster[i]];
  if (as_int(cluster_similarity[best_cluster[i]]) == claimed[anchor]) atomic_min(owner + anchor, i);
}
// 3: a left edge stays if the right edge's best is this left edge or its neighbour on the same curve.
kernel void stereo_mutual(const StereoClusterArguments args, global const int* best_cluster,
                          global const int* cluster_anchor, global const float* left_edges, global const int* owner,
                          global int* keep) {
  const int i = (int)get_global_id(0);
  if (i >= args.left.count) return;
  global const float* left_x = left_edges + args.left.first;
  global const float* left_y = left_x + args.left.stride;
  keep[i] = 0;
  if (best_cluster[i] < 0) return;
  const int best = owner[cluster_anchor[best_cluster[i]]];
  const float dx = left_x[best] - left_x[i], dy = left_y[best] - left_y[i];
  keep[i] = dx * dx + dy * dy <= args.mutual_radius * args.mutual_radius;
}

// Writes the survivors in the order of their left edges. One work-item = one left edge.
// `packed`: blocks of one float per left edge: left x, y, direction, right x, y, direction.
kernel void stereo_collect(const StereoClusterArguments args, global const int* keep_first,
                           global const int* best_cluster, global const float* left_edges, global const float* clusters,
                           global const int* cluster_anchor, global int* left_index, global int* right_index,
                           global float* packed, global float* ncc) {
  const int i = (int)get_global_id(0), stride = args.left.count;
  if (i >= stride || keep_first[i + 1] == keep_first[i]) return;
  const int k = best_cluster[i], row = keep_first[i];
  global const float* left = left_edges + args.left.first + i;
  const float x = left[0], y = left[args.left.stride];
  const EpipolarLine line = epipolar_line(&args.geometry, x, y);
  left_index[row] = i;
  right_index[row] = cluster_anchor[k];
  packed[row] = x;
  packed[stride + row] = y;
  packed[2 * stride + row] = left[2 * args.left.stride];
  packed[3 * stride + row] = line.x + clusters[k] * line.ex;
  packed[4 * stride + row] = line.y + clusters[k] * line.ey;
  packed[5 * stride + row] = clusters[args.capacity + k];
  ncc[row] = clusters[2 * args.capacity + k];
}
