// stereo_refinement.cl: filter 8a and 8b of the stereo cascade: epipolar shift, then photometric refinement along the line.
//
// Needs direction.cl, epipolar.cl and photometric.cl. In: both images as corners, edges, candidate lists.
// Out per candidate: its place `s` on the left edge's epipolar line (px from the point at infinity), how alike both places look,
// and rejected_by = rejected_order where the refinement diverged. One work-item = one left edge.
// Reference: host/reference/stereo_refinement.cpp.

// Candidates that shift onto the line within so many px of one another are one. Twin: kSamePlace in
// host/reference/stereo_refinement.cpp.
#define SAME_PLACE 0.3f
#define STOOD_FOR 255  // in rejected_by, for a while: another candidate is refined for this one

// Moves the candidate onto the line: along its tangent where that is well defined, else orthogonally. Returns its place s.
inline float epipolar_shift(const EpipolarLine line, const float x, const float y, const float direction,
                            const float min_sine, const float max_shift, float* off_line) {
  const float dx = x - line.x, dy = y - line.y;
  const float s = dx * line.ex + dy * line.ey;
  const float distance = -dx * line.ey + dy * line.ex;
  *off_line = fabs(distance);
  float cosine;
  const float sine = sine_cosine(direction, &cosine);
  const float across = -cosine * line.ey + sine * line.ex;  // sine of the angle between line and tangent
  const float along = cosine * line.ex + sine * line.ey;
  if (fabs(across) <= min_sine) return s;
  const float shift = -distance / across;
  return fabs(shift) < max_shift ? s + shift * along : s;
}

kernel void stereo_refinement(global const int* first, global const int* target, const int capacity, const int left_count,
                              global const uint* left_corners, const int left_width, const int left_height,
                              global const uint* right_corners, const int right_width, const int right_height,
                              global const float* left_x, global const float* left_y, global const float* left_direction,
                              global const float* right_x, global const float* right_y, global const float* right_direction,
                              global const float* geometry, const float patch_offset, const float shift_min_sine,
                              const float shift_max, const float stiffness, const int steps, const float tolerance,
                              const float huber, const float clamp_px, const int rejected_order, global uchar* rejected_by,
                              global float* place, global float* likeness) {
  const int i = (int)get_global_id(0);
  if (i >= left_count) return;
  const int begin = first[i], end = min(first[i + 1], capacity);
  if (begin >= end) return;
  const RefinementSettings settings = {steps, tolerance, huber, clamp_px};
  const float x = left_x[i], y = left_y[i];
  const EpipolarLine line = epipolar_line(geometry, x, y);
  // A place known across the edge is known the worse along the line the flatter the edge lies to it.
  const float line_sine = left_epipolar_sine(geometry, x, y, left_direction[i]);
  const float edge_stiffness = stiffness * line_sine * line_sine;
  float cosine;
  const float sine = sine_cosine(left_direction[i], &cosine);
  float8 fixed[3][PATCH_SIDE], derivative[PATCH_SIDE], values[PATCH_SIDE];
  float norms[3];
  int ready = 0;
  // Of candidates at one place the one nearest to the line stays; likeness holds the distances for a while.
  for (int c = begin; c < end; ++c) {
    if (rejected_by[c] != 0) continue;
    const int j = target[c];
    float distance;
    const float s = epipolar_shift(line, right_x[j], right_y[j], right_direction[j], shift_min_sine, shift_max, &distance);
    place[c] = s;
    likeness[c] = distance;
    for (int k = begin; k < c; ++k) {
      if (rejected_by[k] != 0 || fabs(place[k] - s) >= SAME_PLACE) continue;
      const int nearer = distance < likeness[k];
      rejected_by[nearer ? k : c] = STOOD_FOR;
      if (!nearer) break;
    }
  }
  for (int c = begin; c < end; ++c) {
    if (rejected_by[c] != 0) continue;
    if (!ready) {
      for (int side = 0; side < 3; ++side) {
        cut_patch(left_corners, left_width, left_height, patch_frame(x, y, cosine, sine, (float)(side - 1), patch_offset), 0.0f, 0.0f,
                  fixed[side]);
        norms[side] = patch_norm(fixed[side]);
      }
      patch_derivative(left_corners, left_width, left_height, patch_frame(x, y, cosine, sine, 0.0f, 0.0f), line.ex, line.ey,
                       derivative);
      ready = 1;
    }
    float s = place[c];
    // Patches are cut with the left direction in both images.
    const PatchFrame moving = patch_frame(line.x + s * line.ex, line.y + s * line.ey, cosine, sine, 0.0f, 0.0f);
    float move = 0.0f;
    if (!align_edge(right_corners, right_width, right_height, moving, line.ex, line.ey, fixed[1], norms[1], derivative,
                    edge_stiffness, settings, &move)) {
      rejected_by[c] = (uchar)rejected_order;
    }
    s += move;
    place[c] = s;
    float similarity[3];
    for (int side = 0; side < 3; ++side) {
      const PatchFrame frame =
          patch_frame(line.x + s * line.ex, line.y + s * line.ey, cosine, sine, (float)(side - 1), patch_offset);
      cut_patch(right_corners, right_width, right_height, frame, 0.0f, 0.0f, values);
      similarity[side] = rows_ncc(fixed[side], norms[side], values);
    }
    likeness[c] = 0.5f * (similarity[1] + fmax(similarity[0], similarity[2]));
  }
  // The others join their neighbour's cluster, where they count for its direction and cannot represent it.
  for (int c = begin; c < end; ++c) {
    if (rejected_by[c] != STOOD_FOR) continue;
    int nearest = -1;
    for (int k = begin; k < end; ++k) {
      if (rejected_by[k] == 0 && likeness[k] >= -1.0f && (nearest < 0 || fabs(place[k] - place[c]) < fabs(place[nearest] - place[c]))) nearest = k;
    }
    rejected_by[c] = nearest < 0 ? (uchar)rejected_order : 0;
    if (nearest < 0) continue;
    place[c] = place[nearest];
    likeness[c] = likeness[nearest] - 3.0f;
  }
}
