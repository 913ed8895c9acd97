// stereo_mutual.cl: the last filter of the stereo cascade: best and mutual, and the stereo edges that are left.
//
// Needs direction.cl and epipolar.cl. In: the cluster that every left edge has chosen (-1: none) and its score. One
// work-item = one left edge. Maxima and minima of integers do not depend on the order of the work-items.
// Reference: host/workbench/reference/stereo_matching.cpp.

// 1: the highest score that any left edge offers to a right edge (positive floats order like their bits).
kernel void stereo_claim(const StereoMutualArguments args, global const int* chosen, global const float* score,
                         global const int* cluster_anchor, global int* claimed) {
  const int i = (int)get_global_id(0);
  if (i >= args.left.count || chosen[i] < 0) return;
  atomic_max(claimed + cluster_anchor[chosen[i]], as_int(score[i]));
}
// 2: the first left edge that offers it.
kernel void stereo_owner(const StereoMutualArguments args, global const int* chosen, global const float* score,
                         global const int* cluster_anchor, global const int* claimed, global int* owner) {
  const int i = (int)get_global_id(0);
  if (i >= args.left.count || chosen[i] < 0) return;
  const int anchor = cluster_anchor[chosen[i]];
  if (as_int(score[i]) == claimed[anchor]) atomic_min(owner + anchor, i);
}
// 3: a left edge stays if the right edge's best is this left edge, or one within mutual_radius of it, its neighbour
// on the curve.
kernel void stereo_mutual(const StereoMutualArguments args, global const int* chosen, global const int* cluster_anchor,
                          global const float* left_edges, global const int* owner, global int* keep) {
  const int i = (int)get_global_id(0);
  if (i >= args.left.count) return;
  global const float* left_x = left_edges + args.left.first;
  global const float* left_y = left_x + args.left.stride;
  keep[i] = 0;
  if (chosen[i] < 0) return;
  const int best = owner[cluster_anchor[chosen[i]]];
  const float dx = left_x[best] - left_x[i], dy = left_y[best] - left_y[i];
  keep[i] = dx * dx + dy * dy <= args.mutual_radius * args.mutual_radius;
}

// Writes the survivors in the order of their left edges.
// `packed`: blocks of one float per left edge: left x, y, direction, right x, y, direction, left scale-space shift.
kernel void stereo_collect(const StereoMutualArguments args, global const int* keep_first, global const int* chosen,
                           global const float* left_edges, global const float* clusters,
                           global const int* cluster_anchor, global int* left_index, global int* right_index,
                           global float* packed, global float* ncc) {
  const int i = (int)get_global_id(0), stride = args.left.count;
  if (i >= stride || keep_first[i + 1] == keep_first[i]) return;
  const int k = chosen[i], row = keep_first[i];
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
  packed[6 * stride + row] = left[4 * args.left.stride];
  ncc[row] = clusters[2 * args.capacity + k];
}
