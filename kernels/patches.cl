// patches.cl: two side patches of 7 x 7 samples per edge, mean-free with unit norm (SPEC section 2).
//
// In: corners of the image (corners.cl), edges (x, y [px], direction [rad]). Out: 98 floats per edge, laid out as in
// host/reference/patches.hpp. Two forms with the same arithmetic in the same order:
//   ITEMS_PER_EDGE 1: one work-item = one edge, the 7 samples across the edge are the lanes of a float8;
//   ITEMS_PER_EDGE 16: eight work-items per side, one per lane; groups of GROUP work-items, local memory
//   GROUP floats.
// Needs direction.cl before it. Reference: host/reference/patches.cpp.

#ifndef ITEMS_PER_EDGE
#define ITEMS_PER_EDGE 1
#endif
#ifndef GROUP
#define GROUP 64
#endif
#define SIDE 7
#define SAMPLES 49
#define FLAT_SQUARES 1e-10f

#if ITEMS_PER_EDGE == 1
#define REAL float8
#define WHOLE int8
#define WHOLE_BELOW whole_below8
#define TO_REAL convert_float8
inline uint8 gather(global const uint* p, const int8 i) {
  return (uint8)(p[i.s0], p[i.s1], p[i.s2], p[i.s3], p[i.s4], p[i.s5], p[i.s6], p[i.s7]);
}
#define BYTES(corners, shift) convert_float8(as_int8((corners) >> (shift) & (uint8)(255u)))
#define PACKED uint8
#else
#define REAL float
#define WHOLE int
#define WHOLE_BELOW whole_below
#define TO_REAL convert_float
inline uint gather(global const uint* p, const int i) { return p[i]; }
#define BYTES(corners, shift) convert_float((int)((corners) >> (shift) & 255u))
#define PACKED uint
#endif

// Grey level at (x, y), given relative to the pixel (base_x, base_y): small numbers keep their precision.
inline REAL bilinear(global const uint* corners, const int width, const int height, const int base_x, const int base_y,
                     REAL x, REAL y) {
  x = clamp(x, (REAL)((float)-base_x), (REAL)((float)(width - 1 - base_x)));
  y = clamp(y, (REAL)((float)-base_y), (REAL)((float)(height - 1 - base_y)));
  const WHOLE x0 = WHOLE_BELOW(x), y0 = WHOLE_BELOW(y);
  const REAL fx = x - TO_REAL(x0), fy = y - TO_REAL(y0);
  const WHOLE index = (y0 + (WHOLE)(base_y)) * (WHOLE)(width) + (x0 + (WHOLE)(base_x));
  const PACKED four = gather(corners, index);
  const REAL a = BYTES(four, 0), b = BYTES(four, 8), c = BYTES(four, 16), d = BYTES(four, 24);
  const REAL top = a + fx * (b - a), bottom = c + fx * (d - c);
  return top + fy * (bottom - top);
}

// A flat patch becomes zeros.
inline float scale_of(const float squares) { return squares < FLAT_SQUARES ? 0.0f : 1.0f / sqrt(squares); }

#if ITEMS_PER_EDGE == 1

inline float sum_lanes(const float8 v) {
  const float4 four = v.lo + v.hi;
  const float2 two = four.lo + four.hi;
  return two.x + two.y;
}

kernel void side_patches(global const uint* corners, const int width, const int height, global const float* xs,
                         global const float* ys, global const float* directions, const int count, const float offset,
                         global float* patches) {
  const int edge = (int)get_global_id(0);
  if (edge >= count) return;
  float c;
  const float s = sine_cosine(directions[edge], &c);
  const int base_x = whole_below(xs[edge]), base_y = whole_below(ys[edge]);
  const int8 used = (int8)(-1, -1, -1, -1, -1, -1, -1, 0);
  const float8 across = (float8)(-3.0f, -2.0f, -1.0f, 0.0f, 1.0f, 2.0f, 3.0f, 0.0f);
  for (int side = 0; side < 2; ++side) {
    const float to_side = side == 0 ? offset : -offset;
    const float x = (xs[edge] - (float)base_x) + to_side * s, y = (ys[edge] - (float)base_y) - to_side * c;
    float8 rows[SIDE];
    for (int i = 0; i < SIDE; ++i) {
      const float along = (float)(i - SIDE / 2);
      rows[i] = bilinear(corners, width, height, base_x, base_y, (x + along * c) - across * s,
                         (y + along * s) + across * c);
    }
    // Taking the middle sample away first makes a constant patch exactly zero.
    const float middle = rows[SIDE / 2].s3;
    float8 sum = 0.0f;
    for (int i = 0; i < SIDE; ++i) {
      rows[i] = as_float8(as_int8(rows[i] - middle) & used);
      sum += rows[i];
    }
    const float mean = sum_lanes(sum) * (1.0f / SAMPLES);
    float8 squares = 0.0f;
    for (int i = 0; i < SIDE; ++i) {
      rows[i] = as_float8(as_int8(rows[i] - mean) & used);
      squares += rows[i] * rows[i];
    }
    const float scale = scale_of(sum_lanes(squares));
    // Each row's eighth float is overwritten by the next row, the last row's must not be written.
    global float* patch = patches + (size_t)edge * (2 * SAMPLES) + side * SAMPLES;
    for (int i = 0; i < SIDE - 1; ++i) vstore8(rows[i] * scale, 0, patch + i * SIDE);
    const float8 last = rows[SIDE - 1] * scale;
    vstore4(last.lo, 0, patch + SIDE * (SIDE - 1));
    vstore3(last.hi.xyz, 0, patch + SIDE * (SIDE - 1) + 4);
  }
}

#else

// Sum over the eight lanes of a side in the order of a float8's halves; all work-items of the group must call it.
inline float sum_lanes(local float* shared, const float value) {
  const int item = (int)get_local_id(0), lane = item & 7;
  local float* first = shared + (item - lane);
  barrier(CLK_LOCAL_MEM_FENCE);
  shared[item] = value;
  barrier(CLK_LOCAL_MEM_FENCE);
  return ((first[0] + first[4]) + (first[2] + first[6])) + ((first[1] + first[5]) + (first[3] + first[7]));
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void side_patches(global const uint* corners, const int width, const int height, global const float* xs,
                  global const float* ys, global const float* directions, const int count, const float offset,
                  global float* patches) {
  local float shared[GROUP];
  const int item = (int)get_local_id(0), lane = item & 7, side = item >> 3 & 1;
  const int wanted = (int)(get_global_id(0) / ITEMS_PER_EDGE);
  const int edge = min(wanted, count - 1);  // surplus work-items work along with the last edge for the barriers
  float c;
  const float s = sine_cosine(directions[edge], &c);
  const int base_x = whole_below(xs[edge]), base_y = whole_below(ys[edge]);
  const float to_side = side == 0 ? offset : -offset;
  const float x = (xs[edge] - (float)base_x) + to_side * s, y = (ys[edge] - (float)base_y) - to_side * c;
  const float across = (float)(lane - SIDE / 2);
  const bool used = lane < SIDE;
  float rows[SIDE];
  for (int i = 0; i < SIDE; ++i) {
    const float along = (float)(i - SIDE / 2);
    rows[i] = bilinear(corners, width, height, base_x, base_y, (x + along * c) - across * s,
                       (y + along * s) + across * c);
  }
  shared[item] = rows[SIDE / 2];
  barrier(CLK_LOCAL_MEM_FENCE);
  const float middle = shared[item - lane + SIDE / 2];
  float sum = 0.0f;
  for (int i = 0; i < SIDE; ++i) {
    rows[i] = used ? rows[i] - middle : 0.0f;
    sum += rows[i];
  }
  const float mean = sum_lanes(shared, sum) * (1.0f / SAMPLES);
  float squares = 0.0f;
  for (int i = 0; i < SIDE; ++i) {
    rows[i] = used ? rows[i] - mean : 0.0f;
    squares += rows[i] * rows[i];
  }
  const float scale = scale_of(sum_lanes(shared, squares));
  if (!used || wanted >= count) return;
  global float* patch = patches + (size_t)edge * (2 * SAMPLES) + side * SAMPLES;
  for (int i = 0; i < SIDE; ++i) patch[i * SIDE + lane] = rows[i] * scale;
}

#endif
