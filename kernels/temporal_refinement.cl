// temporal_refinement.cl: the circle is closed (a candidate must be alive in the left and in the right images), then filters 6
// and 7 of the temporal cascade: photometric refinement of place and disparity together, and clustering.
//
// Needs direction.cl, epipolar.cl and photometric.cl; images come as corners. Row r belongs to previous stereo edge r * row_step.
// Reference: host/reference/temporal_refinement.cpp.

// One work-item = one row. A living left candidate stays if the right list holds the same current edge alive; `score` becomes the mean
// of both NCC and `right_pairing` the right list's pairing.
kernel void temporal_agreement(global const int* left_first, global const int* left_target, const int left_capacity,
                               global const float* left_ncc, global uchar* left_rejected_by, global const int* right_first,
                               global const int* right_target, const int right_capacity, global const float* right_ncc,
                               global const uchar* right_pairing_of, global const uchar* right_rejected_by, const int rows,
                               const int rejected_order, global float* score, global uchar* right_pairing) {
  const int row = (int)get_global_id(0);
  if (row >= rows) return;
  const int left_end = min(left_first[row + 1], left_capacity), right_end = min(right_first[row + 1], right_capacity);
  for (int c = left_first[row]; c < left_end; ++c) {
    if (left_rejected_by[c] != 0) continue;
    int found = -1;
    for (int d = right_first[row]; d < right_end && found < 0; ++d) {
      if (right_rejected_by[d] == 0 && right_target[d] == left_target[c]) found = d;
    }
    if (found < 0) {
      left_rejected_by[c] = (uchar)rejected_order;
    } else {
      score[c] = 0.5f * (left_ncc[c] + right_ncc[found]);
      right_pairing[c] = right_pairing_of[found];
    }
  }
}

// Gauss-Newton on the move (dx, dy) in the current image, held by a prior of `stiffness` (grey levels^2 / px^2) around the start.
// `turn` = previous minus current direction: turns axes of the current image into those of the previous one.
inline int align_freely(global const uint* fixed_corners, global const uint* corners, const int width, const int height,
                        const PatchFrame fixed, const PatchFrame moving, const float turn, const float stiffness,
                        const RefinementSettings settings, float* dx, float* dy) {
  float8 goal[PATCH_SIDE], gx[PATCH_SIDE], gy[PATCH_SIDE], values[PATCH_SIDE];
  float cosine;
  const float sine = sine_cosine(turn, &cosine);
  cut_patch(fixed_corners, width, height, fixed, 0.0f, 0.0f, goal);
  patch_derivative(fixed_corners, width, height, fixed, cosine, sine, gx);
  patch_derivative(fixed_corners, width, height, fixed, -sine, cosine, gy);
  float x = 0.0f, y = 0.0f, rms = 0.0f;
  for (int step = 0; step < settings.steps; ++step) {
    cut_patch(corners, width, height, moving, x, y, values);
    float8 xxs = 0.0f, xys = 0.0f, yys = 0.0f, bxs = 0.0f, bys = 0.0f, squares = 0.0f;
#pragma unroll
    for (int i = 0; i < PATCH_SIDE; ++i) {
      const float8 residual = goal[i] - values[i];
      const float8 weight = huber_weight(residual, settings.huber);
      const float8 weighted_x = weight * gx[i], weighted_y = weight * gy[i];
      xxs += weighted_x * gx[i];
      xys += weighted_x * gy[i];
      yys += weighted_y * gy[i];
      bxs += weighted_x * residual;
      bys += weighted_y * residual;
      squares += residual * residual;
    }
    rms = root_mean_square(squares);
    const float xx = stiffness + sum_used(xxs), xy = sum_used(xys), yy = stiffness + sum_used(yys);
    const float bx = sum_used(bxs) - stiffness * x, by = sum_used(bys) - stiffness * y;
    const float determinant = xx * yy - xy * xy;
    const float change_x = (yy * bx - xy * by) / determinant, change_y = (xx * by - xy * bx) / determinant;
    x += change_x;
    y += change_y;
    if (!(x * x + y * y <= settings.clamp * settings.clamp)) return 0;
    if (change_x * change_x + change_y * change_y < settings.tolerance * settings.tolerance) break;
  }
  *dx = x;
  *dy = y;
  return rms <= settings.rms_max;
}

// The same along one line (unit vector (ex, ey) in the current image).
inline int align_along_held(global const uint* fixed_corners, global const uint* corners, const int width, const int height,
                            const PatchFrame fixed, const PatchFrame moving, const float turn, const float ex, const float ey,
                            const float stiffness, const RefinementSettings settings, float* alpha) {
  float8 goal[PATCH_SIDE], derivative[PATCH_SIDE];
  float cosine;
  const float sine = sine_cosine(turn, &cosine);
  cut_patch(fixed_corners, width, height, fixed, 0.0f, 0.0f, goal);
  patch_derivative(fixed_corners, width, height, fixed, cosine * ex - sine * ey, sine * ex + cosine * ey, derivative);
  return align_along_line(corners, width, height, moving, ex, ey, goal, derivative, stiffness, settings, alpha);
}

// A stereo edge's arrays come packed as x, y, direction blocks of `count` floats each: left (3 blocks), then right (3 blocks).
#define LEFT_X(edges, count, i) (edges)[i]
#define LEFT_Y(edges, count, i) (edges)[(count) + (i)]
#define LEFT_DIRECTION(edges, count, i) (edges)[2 * (count) + (i)]
#define RIGHT_X(edges, count, i) (edges)[3 * (count) + (i)]
#define RIGHT_Y(edges, count, i) (edges)[4 * (count) + (i)]
#define RIGHT_DIRECTION(edges, count, i) (edges)[5 * (count) + (i)]

// One work-item = one row. Refines its living candidates: left place freely, then the right point along its epipolar line.
// Out per candidate: refined (left x, left y, right x, right y) in `refined`.
kernel void temporal_refinement(global const int* first, global const int* target, const int capacity, const int rows,
                                const int row_step, global const uint* previous_left, global const uint* previous_right,
                                global const uint* current_left, global const uint* current_right, const int left_width,
                                const int left_height, const int right_width, const int right_height,
                                global const float* previous, const int previous_count, global const float* current,
                                const int current_count, global const float* geometry, global const uchar* left_pairing,
                                global const uchar* right_pairing, const float patch_offset, const float stiffness,
                                const int steps, const float tolerance, const float huber, const float clamp_px,
                                const float rms_max, const int rejected_order, global uchar* rejected_by,
                                global float* refined) {
  const int row = (int)get_global_id(0);
  if (row >= rows) return;
  const int i = row * row_step;
  const RefinementSettings settings = {steps, tolerance, huber, clamp_px, rms_max};
  const int end = min(first[row + 1], capacity);
  for (int c = first[row]; c < end; ++c) {
    if (rejected_by[c] != 0) continue;
    const int j = target[c];
    const float jx = LEFT_X(current, current_count, j), jy = LEFT_Y(current, current_count, j);
    const float before = LEFT_DIRECTION(previous, previous_count, i), after = LEFT_DIRECTION(current, current_count, j);
    // Neighbouring frames keep the contrast: the side that matched best in the previous image is the same one now.
    const float side = (left_pairing[c] & 1) == 0 ? 1.0f : -1.0f;
    const PatchFrame fixed = directed_frame(LEFT_X(previous, previous_count, i), LEFT_Y(previous, previous_count, i), before, side,
                                            patch_offset);
    const PatchFrame moving = directed_frame(jx, jy, after, side, patch_offset);
    float dx = 0.0f, dy = 0.0f, alpha = 0.0f;
    int good = align_freely(previous_left, current_left, left_width, left_height, fixed, moving, before - after, stiffness,
                            settings, &dx, &dy);
    float x = jx + dx, y = jy + dy, right_x = 0.0f, right_y = 0.0f;
    if (good) {
      const EpipolarLine old_line = epipolar_line(geometry, jx, jy), line = epipolar_line(geometry, x, y);
      const float s = (RIGHT_X(current, current_count, j) - old_line.x) * old_line.ex +
                      (RIGHT_Y(current, current_count, j) - old_line.y) * old_line.ey;
      const float right_side = (right_pairing[c] & 1) == 0 ? 1.0f : -1.0f;
      const float right_before = RIGHT_DIRECTION(previous, previous_count, i);
      const float right_after = RIGHT_DIRECTION(current, current_count, j);
      const PatchFrame right_fixed =
          directed_frame(RIGHT_X(previous, previous_count, i), RIGHT_Y(previous, previous_count, i), right_before, right_side,
                         patch_offset);
      const PatchFrame right_moving = directed_frame(line.x + s * line.ex, line.y + s * line.ey, right_after, right_side,
                                                     patch_offset);
      good = align_along_held(previous_right, current_right, right_width, right_height, right_fixed, right_moving,
                              right_before - right_after, line.ex, line.ey, stiffness, settings, &alpha);
      right_x = line.x + (s + alpha) * line.ex;
      right_y = line.y + (s + alpha) * line.ey;
    }
    if (!good) rejected_by[c] = (uchar)rejected_order;
    vstore4((float4)(x, y, right_x, right_y), (size_t)c, refined);
  }
}

// One work-item = one row. Joins living candidates whose left places chain up within cluster_gap with directions within
// cluster_orientation; the cluster with the member of the highest score wins and is represented by its centroid and that member.
// Out per row: best (current edge, -1: none), rivals (other clusters), score, refined place in both images. `label` is scratch.
kernel void temporal_clusters(global const int* first, global const int* target, const int capacity, const int rows,
                              global const float* current, const int current_count, global const uchar* rejected_by,
                              global const float* refined, global const float* score, const float cluster_gap,
                              const float cluster_orientation, global int* label, global int* best, global int* rivals,
                              global float* best_score, global float* best_place) {
  const int row = (int)get_global_id(0);
  if (row >= rows) return;
  const int begin = first[row], end = min(first[row + 1], capacity);
  for (int c = begin; c < end; ++c) label[c] = rejected_by[c] == 0 ? c : -1;
  for (int changed = 1; changed;) {
    changed = 0;
    for (int c = begin; c < end; ++c) {
      if (label[c] < 0) continue;
      for (int d = begin; d < c; ++d) {
        if (label[d] < 0 || label[d] == label[c]) continue;
        const float dx = refined[4 * (size_t)c] - refined[4 * (size_t)d];
        const float dy = refined[4 * (size_t)c + 1] - refined[4 * (size_t)d + 1];
        if (dx * dx + dy * dy >= cluster_gap * cluster_gap) continue;
        if (angle_between(LEFT_DIRECTION(current, current_count, target[c]), LEFT_DIRECTION(current, current_count, target[d])) >
            cluster_orientation) {
          continue;
        }
        label[c] = label[d] = min(label[c], label[d]);
        changed = 1;
      }
    }
  }
  int winner = -1, clusters = 0;
  for (int c = begin; c < end; ++c) {
    if (label[c] < 0) continue;
    if (label[c] == c) ++clusters;
    if (winner < 0 || score[c] > score[winner]) winner = c;
  }
  best[row] = winner < 0 ? -1 : target[winner];
  if (winner < 0) return;
  float4 sum = (float4)(0.0f);
  int members = 0;
  for (int c = begin; c < end; ++c) {
    if (label[c] != label[winner]) continue;
    sum += vload4((size_t)c, refined);
    ++members;
  }
  rivals[row] = clusters - 1;
  best_score[row] = score[winner];
  vstore4(sum / (float)members, (size_t)row, best_place);
}
