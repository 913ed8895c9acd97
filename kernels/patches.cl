// patches.cl: two side patches of 7 x 7 samples per edge, mean-free with unit norm (SPEC section 2).
//
// In: corners of the image (corners.cl), edges (x, y [px], direction [rad]). Out: 112 floats per edge, laid out as in
// host/reference/patches.hpp. Two forms with the same arithmetic in the same order:
//   ITEMS_PER_EDGE 1: one work-item = one edge, the samples across the edge of both sides are the lanes of a float16;
//   ITEMS_PER_EDGE 16: eight work-items per side, one per lane; groups of GROUP work-items, local memory
//   GROUP floats.
// Needs direction.cl and photometric.cl before it. Reference: host/reference/patches.cpp.

#ifndef ITEMS_PER_EDGE
#define ITEMS_PER_EDGE 1
#endif
#ifndef GROUP
#define GROUP 64
#endif
#define EDGE_FLOATS 112
#define FLAT_SQUARES 1e-10f

// A flat patch becomes zeros.
inline float scale_of(const float squares) { return squares < FLAT_SQUARES ? 0.0f : 1.0f / sqrt(squares); }

#if ITEMS_PER_EDGE == 1

kernel void side_patches(global const uint* corners, const int width, const int height, global const float* xs,
                         global const float* ys, global const float* directions, const int count, const float offset,
                         global float* patches) {
  const int edge = (int)get_global_id(0);
  if (edge >= count) return;
  float cosine;
  const float sine = sine_cosine(directions[edge], &cosine);
  global float* patch = patches + (size_t)edge * EDGE_FLOATS;
  const float x = xs[edge], y = ys[edge];
  float16 rows[PATCH_SIDE];
  cut_two_patches(corners, width, height, patch_frame(x, y, cosine, sine, 1.0f, offset),
                  patch_frame(x, y, cosine, sine, -1.0f, offset), rows);
  float16 squares = 0.0f;
  for (int i = 0; i < PATCH_SIDE; ++i) squares += rows[i] * rows[i];
  const float16 scale = (float16)((float8)(scale_of(sum_used(squares.lo))), (float8)(scale_of(sum_used(squares.hi))));
  for (int i = 0; i < PATCH_SIDE; ++i) {
    const float16 row = rows[i] * scale;
    vstore16((float16)(used_lanes(row.lo), used_lanes(row.hi)), i, patch);
  }
}

#else

// Sum over the seven used lanes of a side in the order of sum_used(); all work-items of the group must call it.
inline float sum_lanes(local float* shared, const float value) {
  const int item = (int)get_local_id(0), lane = item & 7;
  local float* first = shared + (item - lane);
  barrier(CLK_LOCAL_MEM_FENCE);
  shared[item] = lane < PATCH_SIDE ? value : 0.0f;
  barrier(CLK_LOCAL_MEM_FENCE);
  return ((first[0] + first[4]) + (first[2] + first[6])) + ((first[1] + first[5]) + (first[3] + first[7]));
}

inline float corner_byte(const uint corners, const uint shift) { return (float)(int)(corners >> shift & 255u); }

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void side_patches(global const uint* corners, const int width, const int height, global const float* xs,
                  global const float* ys, global const float* directions, const int count, const float offset,
                  global float* patches) {
  local float shared[GROUP];
  const int item = (int)get_local_id(0), lane = item & 7, side = item >> 3 & 1;
  const int wanted = (int)(get_global_id(0) / ITEMS_PER_EDGE);
  const int edge = min(wanted, count - 1);  // surplus work-items work along with the last edge for the barriers
  float cosine;
  const float sine = sine_cosine(directions[edge], &cosine);
  const PatchFrame frame = patch_frame(xs[edge], ys[edge], cosine, sine, side == 0 ? 1.0f : -1.0f, offset);
  const float across = lane < PATCH_SIDE ? (float)(lane - PATCH_SIDE / 2) : 0.0f;
  const int base_x = (int)frame.x - PATCH_REACH, base_y = (int)frame.y - PATCH_REACH;
  const float middle_x = (frame.x - (float)base_x) - across * sine, middle_y = (frame.y - (float)base_y) + across * cosine;
  const int origin = base_y * width + base_x;
  float rows[PATCH_SIDE];
  for (int i = 0; i < PATCH_SIDE; ++i) {
    const float along = (float)(i - PATCH_SIDE / 2);
    const float u = clamp(middle_x + along * cosine, (float)-base_x, (float)(width - 1 - base_x));
    const float v = clamp(middle_y + along * sine, (float)-base_y, (float)(height - 1 - base_y));
    const int u0 = (int)u, v0 = (int)v;
    const float fx = u - (float)u0, fy = v - (float)v0;
    const uint four = corners[origin + v0 * width + u0];
    const float a = corner_byte(four, 0), b = corner_byte(four, 8), c = corner_byte(four, 16), d = corner_byte(four, 24);
    const float top = a + fx * (b - a), bottom = c + fx * (d - c);
    rows[i] = top + fy * (bottom - top);
  }
  shared[item] = rows[PATCH_SIDE / 2];
  barrier(CLK_LOCAL_MEM_FENCE);
  const float middle = shared[item - lane + PATCH_SIDE / 2];
  float sum = 0.0f;
  for (int i = 0; i < PATCH_SIDE; ++i) {
    rows[i] -= middle;
    sum += rows[i];
  }
  const float mean = sum_lanes(shared, sum) * (1.0f / PATCH_SAMPLES);
  float squares = 0.0f;
  for (int i = 0; i < PATCH_SIDE; ++i) {
    rows[i] -= mean;
    squares += rows[i] * rows[i];
  }
  const float scale = scale_of(sum_lanes(shared, squares));
  if (wanted >= count) return;
  global float* patch = patches + (size_t)edge * EDGE_FLOATS + 8 * side + lane;
  for (int i = 0; i < PATCH_SIDE; ++i) patch[16 * i] = lane < PATCH_SIDE ? rows[i] * scale : 0.0f;
}

#endif
