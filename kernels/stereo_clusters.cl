// stereo_clusters.cl: filters 8c to 10 of the stereo cascade: clustering along the epipolar line, NCC of the representatives,
// best and mutual.
//
// Needs direction.cl, epipolar.cl and photometric.cl. Cluster k of left edge i is element first[i] + k of the cluster arrays.
// Reference: host/reference/stereo_clusters.cpp.

// Members whose distances to the centroid differ by less are equally near [px]: the first right edge in scan order counts. Members
// that the refinement led to the same place, and the two of a pair, always are; rounding must not choose between them.
// Twin: kAnchorTie in host/reference/stereo_clusters.cpp.
#define ANCHOR_TIE 1e-2f

// One work-item = one left edge. Sorts its living candidates by place, cuts the row where the gap reaches cluster_gap, the direction
// differs by more than cluster_orientation, or cluster_size_max is reached. `order` is scratch.
kernel void stereo_clusters(global const int* first, global const int* target, const int capacity, const int left_count,
                            global const float* right_direction, global const uchar* rejected_by, global const float* place,
                            const float cluster_gap, const float cluster_orientation, const int cluster_size_max,
                            const float cluster_sigma, global int* order, global int* cluster_count,
                            global float* cluster_place, global float* cluster_direction, global int* cluster_anchor) {
  const int i = (int)get_global_id(0);
  if (i >= left_count) return;
  const int begin = first[i], end = min(first[i + 1], capacity);
  int alive = 0;
  for (int c = begin; c < end; ++c) {
    if (rejected_by[c] != 0) continue;
    int k = begin + alive;
    for (; k > begin && place[order[k - 1]] > place[c]; --k) order[k] = order[k - 1];
    order[k] = c;
    ++alive;
  }
  int clusters = 0;
  int from = begin;
  while (from < begin + alive) {
    int to = from + 1;
    while (to < begin + alive && to - from < cluster_size_max && place[order[to]] - place[order[to - 1]] < cluster_gap &&
           line_angle_between(right_direction[target[order[to]]], right_direction[target[order[to - 1]]]) <= cluster_orientation) {
      ++to;
    }
    float sum = 0.0f;
    for (int k = from; k < to; ++k) sum += place[order[k]];
    const float centroid = sum / (float)(to - from);
    float cosine = 0.0f, sine = 0.0f, nearest = INFINITY;
    for (int k = from; k < to; ++k) {
      const float distance = fabs(place[order[k]] - centroid);
      const float direction = right_direction[target[order[k]]];
      const float weight = exp(-0.5f * (distance / cluster_sigma) * (distance / cluster_sigma));
      float doubled_cosine;
      const float doubled_sine = sine_cosine(2.0f * direction, &doubled_cosine);
      cosine += weight * doubled_cosine;
      sine += weight * doubled_sine;
      nearest = fmin(nearest, distance);
    }
    int anchor = INT_MAX;
    for (int k = from; k < to; ++k) {
      if (fabs(place[order[k]] - centroid) <= nearest + ANCHOR_TIE) anchor = min(anchor, target[order[k]]);
    }
    // The mean of the doubled angles leaves the polarity open: it is the anchor's.
    float direction = 0.5f * atan2(sine, cosine);
    if (angle_between(direction, right_direction[anchor]) > 0.5f * PI_F) direction += direction > 0.0f ? -PI_F : PI_F;
    cluster_place[begin + clusters] = centroid;
    cluster_direction[begin + clusters] = direction;
    cluster_anchor[begin + clusters] = anchor;
    ++clusters;
    from = to;
  }
  cluster_count[i] = clusters;
}

// Row i of a stored patch in the layout of photometric.cl. The last row must not be read beyond its end.
inline float8 stored_row(global const float* patch, const int i) {
  return i < PATCH_SIDE - 1 ? vload8(0, patch + PATCH_SIDE * i) : vload8(0, patch + PATCH_SIDE * i - 1).s12345677;
}

// Highest NCC of a freshly cut representative with the left edge's stored patches.
inline float representative_ncc(global const float* left_patches, global const uint* corners, const int width,
                                const int height, const float x, const float y, const float direction,
                                const float patch_offset) {
  float best = -1.0f;
  float cosine;
  const float sine = sine_cosine(direction, &cosine);
  for (int side = 0; side < 2; ++side) {
    float8 values[PATCH_SIDE];
    const PatchFrame frame = patch_frame(x, y, cosine, sine, side == 0 ? 1.0f : -1.0f, patch_offset);
    cut_patch(corners, width, height, frame, 0.0f, 0.0f, values);
    float8 squares = 0.0f, dark = 0.0f, bright = 0.0f;
#pragma unroll
    for (int i = 0; i < PATCH_SIDE; ++i) {
      squares += values[i] * values[i];
      dark += values[i] * stored_row(left_patches, i);
      bright += values[i] * stored_row(left_patches + PATCH_SAMPLES, i);
    }
    const float norm = sum_used(squares);
    if (norm < 1e-10f) continue;
    best = fmax(best, fmax(sum_used(dark), sum_used(bright)) / sqrt(norm));
  }
  return best;
}

// One work-item = one left edge: NCC of its clusters and the best of those that reach ncc_min (-1: none).
kernel void stereo_best(global const int* first, const int left_count, global const float* left_x, global const float* left_y,
                        global const float* left_patches, global const uint* right_corners, const int right_width,
                        const int right_height, global const float* geometry, const float patch_offset, const float ncc_min,
                        global const int* cluster_count, global const float* cluster_place,
                        global const float* cluster_direction, global float* cluster_ncc, global int* best_cluster) {
  const int i = (int)get_global_id(0);
  if (i >= left_count) return;
  const EpipolarLine line = epipolar_line(geometry, left_x[i], left_y[i]);
  int best = -1;
  for (int k = first[i]; k < first[i] + cluster_count[i]; ++k) {
    const float ncc = representative_ncc(left_patches + 98 * (size_t)i, right_corners, right_width, right_height,
                                         line.x + cluster_place[k] * line.ex, line.y + cluster_place[k] * line.ey,
                                         cluster_direction[k], patch_offset);
    cluster_ncc[k] = ncc;
    if (ncc >= ncc_min && (best < 0 || ncc > cluster_ncc[best])) best = k;
  }
  best_cluster[i] = best;
}

// Mutual best in three launches over the left edges. Maxima and minima of integers do not depend on the order of the work-items.
// 1: the highest NCC that any left edge offers to a right edge (positive floats order like their bits).
kernel void stereo_claim(global const int* best_cluster, global const int* cluster_anchor, global const float* cluster_ncc,
                         const int left_count, global int* claimed_ncc) {
  const int i = (int)get_global_id(0);
  if (i >= left_count || best_cluster[i] < 0) return;
  atomic_max(claimed_ncc + cluster_anchor[best_cluster[i]], as_int(cluster_ncc[best_cluster[i]]));
}
// 2: the first left edge that offers it.
kernel void stereo_owner(global const int* best_cluster, global const int* cluster_anchor, global const float* cluster_ncc,
                         const int left_count, global const int* claimed_ncc, global int* owner) {
  const int i = (int)get_global_id(0);
  if (i >= left_count || best_cluster[i] < 0) return;
  const int anchor = cluster_anchor[best_cluster[i]];
  if (as_int(cluster_ncc[best_cluster[i]]) == claimed_ncc[anchor]) atomic_min(owner + anchor, i);
}
// 3: a left edge stays if the right edge's best is this left edge or its neighbour on the same curve.
kernel void stereo_mutual(global const int* best_cluster, global const int* cluster_anchor, const int left_count,
                          global const float* left_x, global const float* left_y, const float mutual_radius,
                          global const int* owner, global int* keep) {
  const int i = (int)get_global_id(0);
  if (i >= left_count) return;
  keep[i] = 0;
  if (best_cluster[i] < 0) return;
  const int best = owner[cluster_anchor[best_cluster[i]]];
  const float dx = left_x[best] - left_x[i], dy = left_y[best] - left_y[i];
  keep[i] = dx * dx + dy * dy <= mutual_radius * mutual_radius;
}

// Writes the survivors in the order of their left edges. One work-item = one left edge.
// `packed`: blocks of `stride` floats: left x, y, direction, right x, y, direction; the right ones also stand alone.
kernel void stereo_collect(global const int* keep_first, const int left_count, global const int* best_cluster,
                           global const float* left_x, global const float* left_y, global const float* left_direction,
                           global const float* geometry, global const float* cluster_place,
                           global const float* cluster_direction, global const int* cluster_anchor,
                           global const float* cluster_ncc, const int stride, global int* left_index,
                           global int* right_index, global float* packed, global float* right_x, global float* right_y,
                           global float* right_direction, global float* ncc) {
  const int i = (int)get_global_id(0);
  if (i >= left_count || keep_first[i + 1] == keep_first[i]) return;
  const int k = best_cluster[i], row = keep_first[i];
  const EpipolarLine line = epipolar_line(geometry, left_x[i], left_y[i]);
  left_index[row] = i;
  right_index[row] = cluster_anchor[k];
  packed[row] = left_x[i];
  packed[stride + row] = left_y[i];
  packed[2 * stride + row] = left_direction[i];
  packed[3 * stride + row] = right_x[row] = line.x + cluster_place[k] * line.ex;
  packed[4 * stride + row] = right_y[row] = line.y + cluster_place[k] * line.ey;
  packed[5 * stride + row] = right_direction[row] = cluster_direction[k];
  ncc[row] = cluster_ncc[k];
}

// Copies the descriptions that the matching in time needs beside the stereo edges: the left edge's patches and SIFT, the right
// anchor's SIFT (its patches are cut anew). One work-item = one stereo edge.
kernel void stereo_gather(global const int* left_index, global const int* right_index, const int count,
                          global const float* left_patches, global const uchar* left_sift, global const uchar* right_sift,
                          global float* out_left_patches, global uchar* out_left_sift, global uchar* out_right_sift) {
  const int row = (int)get_global_id(0);
  if (row >= count) return;
  const size_t left = (size_t)left_index[row], right = (size_t)right_index[row], to = (size_t)row;
  for (int k = 0; k < 98; ++k) out_left_patches[98 * to + k] = left_patches[98 * left + k];
  for (int k = 0; k < 16; ++k) {
    vstore16(vload16(k, left_sift + 256 * left), k, out_left_sift + 256 * to);
    vstore16(vload16(k, right_sift + 256 * right), k, out_right_sift + 256 * to);
  }
}
