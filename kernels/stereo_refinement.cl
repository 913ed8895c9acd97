// stereo_refinement.cl: filter 8a and 8b of the stereo cascade: epipolar shift, then photometric refinement along the line.
//
// Needs direction.cl, epipolar.cl and photometric.cl. In: both images as corners, edges, candidate lists with their side pairing.
// Out per candidate: its place `s` on the left edge's epipolar line (px from the point at infinity); rejected_by = REJECTED
// where the refinement diverged. One work-item = one left edge.
// Reference: host/reference/stereo_refinement.cpp.

// Moves the candidate onto the line: along its tangent where that is well defined, else orthogonally. Returns its place s.
inline float epipolar_shift(const EpipolarLine line, const float x, const float y, const float direction,
                            const float min_sine, const float max_shift) {
  const float dx = x - line.x, dy = y - line.y;
  const float s = dx * line.ex + dy * line.ey;
  const float distance = -dx * line.ey + dy * line.ex;
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
                              global const float* geometry, global const uchar* pairing, const float patch_offset,
                              const float shift_min_sine, const float shift_max, const float stiffness, const int steps, const float tolerance,
                              const float huber, const float clamp_px, const float rms_max, const int rejected_order,
                              global uchar* rejected_by, global float* place) {
  const int i = (int)get_global_id(0);
  if (i >= left_count) return;
  const int begin = first[i], end = min(first[i + 1], capacity);
  if (begin >= end) return;
  const RefinementSettings settings = {steps, tolerance, huber, clamp_px, rms_max};
  const EpipolarLine line = epipolar_line(geometry, left_x[i], left_y[i]);
  float cosine;
  const float sine = sine_cosine(left_direction[i], &cosine);
  float8 fixed[2][PATCH_SIDE], derivative[2][PATCH_SIDE];
  int ready[2] = {0, 0};
  for (int c = begin; c < end; ++c) {
    if (rejected_by[c] != 0) continue;
    const int j = target[c];
    const float s = epipolar_shift(line, right_x[j], right_y[j], right_direction[j], shift_min_sine, shift_max);
    // Pairings: 0 dark-dark, 1 bright-bright, 2 dark-bright, 3 bright-dark.
    const int left_side = pairing[c] & 1;
    const int right_side = pairing[c] == 1 || pairing[c] == 2;
    if (!ready[left_side]) {
      const PatchFrame frame = patch_frame(left_x[i], left_y[i], cosine, sine, left_side ? -1.0f : 1.0f, patch_offset);
      cut_patch(left_corners, left_width, left_height, frame, 0.0f, 0.0f, fixed[left_side]);
      patch_derivative(left_corners, left_width, left_height, frame, line.ex, line.ey, derivative[left_side]);
      ready[left_side] = 1;
    }
    // Both patches are cut with the left direction, turned by half a turn where the right edge has the other polarity.
    const float turn = angle_between(right_direction[j], left_direction[i]) > 0.5f * PI_F ? -1.0f : 1.0f;
    const PatchFrame moving = patch_frame(line.x + s * line.ex, line.y + s * line.ey, turn * cosine, turn * sine,
                                          right_side ? -1.0f : 1.0f, patch_offset);
    float alpha = 0.0f;
    const int good = align_along_line(right_corners, right_width, right_height, moving, turn * line.ex, turn * line.ey,
                                      fixed[left_side], derivative[left_side], stiffness, settings, &alpha);
    place[c] = s + turn * alpha;
    if (!good) rejected_by[c] = (uchar)rejected_order;
  }
}
