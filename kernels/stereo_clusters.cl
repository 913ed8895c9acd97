// stereo_clusters.cl: filter 8c of the stereo cascade: clustering along the epipolar line.
//
// Needs direction.cl. Cluster k of left edge i is element first[i] + k of each block of `clusters` and
// of cluster_anchor.
// Reference: host/workbench/reference/stereo_matching.cpp.

// Criterion for the representative of a cluster: alive candidates come before represented ones.
static inline float rank_in_cluster(global const uchar* state, global const float* similarity, const int c) {
  return state[c] == kCandidateRepresented ? similarity[c] - kBehindAll : similarity[c];
}

// The mean direction of the members order[from] .. order[to - 1], weighted by their distance from `middle`.
static inline float mean_direction(global const float* position, global const float* right_direction,
                                   global const int* target, global const int* order, const int from, const int to,
                                   const float middle, const float sigma) {
  float cosine = 0.0f, sine = 0.0f;
  for (int k = from; k < to; ++k) {
    const float distance = position[order[k]] - middle;
    const float weight = exp(-0.5f * (distance / sigma) * (distance / sigma));
    float member_cosine;
    const float member_sine = sine_cosine(right_direction[target[order[k]]], &member_cosine);
    cosine += weight * member_cosine;
    sine += weight * member_sine;
  }
  return atan2(sine, cosine);
}

// One work-item = one left edge. Sorts its alive and represented candidates by position, cuts the row where the gap
// reaches cluster_gap, the direction differs by more than cluster_orientation, or cluster_size_max is reached. The most
// similar member represents a cluster. `order` is scratch.
kernel void stereo_clusters(const StereoClusterArguments args, global const int* first, global const int* target,
                            global const float* right_edges, global const uchar* state, global const float* position,
                            global const float* similarity, global int* order, global int* cluster_count,
                            global float* clusters, global int* cluster_anchor) {
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
  int found = 0;
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
    const int k = begin + found;
    cluster_position[k] = position[chosen];
    cluster_direction[k] = to - from == 1 ? right_direction[target[chosen]]
                                          : mean_direction(position, right_direction, target, order, from, to,
                                                           position[chosen], args.cluster_sigma);
    cluster_anchor[k] = target[chosen];
    cluster_similarity[k] = chosen_rank;
    ++found;
    from = to;
  }
  cluster_count[i] = found;
}
