// edge_detection_strip.cl: edge detection for CPUs. One work-item walks along rows, 16 pixels at a time; needs
// edge_detection.cl.

// The lower 16 bits of both, in turn.
static inline uint interleave_bits(const uint even, const uint odd) {
  ulong bits = (ulong)even | (ulong)odd << 32;
  bits = (bits | bits << 8) & 0x00ff00ff00ff00fful;
  bits = (bits | bits << 4) & 0x0f0f0f0f0f0f0f0ful;
  bits = (bits | bits << 2) & 0x3333333333333333ul;
  bits = (bits | bits << 1) & 0x5555555555555555ul;
  return (uint)bits | (uint)(bits >> 31);
}

// Gradient and maximum test of strip_rows rows of the doubled grid per work-item.
//
// scratch: kStripLines lines of `line` floats per work-item (2 of column sums, then for 3 rows x 2 phases gx, gy and
// magnitude).
// Out: winners, the cells of grid row r from 4 * r * 2 * width on, in scan order; counts[r], for all 2 * height rows.
// LONG: one pass over a strip; its sums stay in registers from row to row.
kernel IN_VECTORS void edges_strip_maxima(const DetectionArguments args, global const float* threshold_of_frame,
                                          const int strip_rows, global const float* plane, global const float* taps,
                                          global float* scratch, const int line, global float* winners,
                                          global int* counts) {
  const int stride = args.plane_stride, width = args.width, height = args.height, margin = args.margin;
  const float threshold = threshold_of_frame[0];
  const int strip = (int)get_global_id(0);
  const int first_row = strip * strip_rows, last_row = min(first_row + strip_rows, 2 * height);
  if (first_row >= last_row) return;
  global float* lines = scratch + (size_t)strip * kStripLines * line + kStripLineFront;
  global float* smooth_y = lines;
  global float* slope_y = lines + line;
  // Rows and columns of cells strictly inside the margin; the pixels that hold them and their neighbours.
  const int begin_y = max(first_row, 2 * margin + 1), end_y = min(last_row, 2 * (height - 1 - margin));
  const int begin_x = 2 * margin + 1, end_x = 2 * (width - 1 - margin);
  const int pixels = end_x > begin_x ? width - 2 * margin : 0;
  for (int row = first_row; row < last_row; ++row) {
    if (row < begin_y || row >= end_y || pixels == 0) counts[row] = 0;
  }
  if (pixels == 0) return;
  // Column sums start at the last multiple of 16 floats of the plane that is far enough to the left: aligned vectors
  // take one access to the cache, others two.
  const int skipped = (margin - RADIUS + PAD_X) & 15;

  for (int row = begin_y - 1; row <= end_y; ++row) {
    if (begin_y >= end_y) break;
    // Along y: column sums for the pixels margin - RADIUS - skipped .. width - 1 - margin + RADIUS + 1.
    const int phase_y = row & 1;
    global const float* source = plane + ((row >> 1) + PAD_Y) * stride + PAD_X + margin - RADIUS - skipped;
    global const float* weights_g = SMOOTH_TAPS(taps, phase_y);
    global const float* weights_dg = SLOPE_TAPS(taps, phase_y);
    for (int i = 0; i < skipped + pixels + 2 * PAIRS; i += 16) {
#define AT(k) LOAD(source + i + (k)*stride)
      float16 g, dg;
      SMOOTH(float16, g, AT, weights_g, phase_y)
      SLOPE(float16, dg, AT, weights_dg, phase_y)
#undef AT
      STORE(g, smooth_y + i);
      STORE(dg, slope_y + i);
    }
    // Along x: gradient and magnitude of both phases.
    global float* now = lines + (2 + 6 * ((row + 3) % 3)) * line;
    for (int i = 0; i < pixels; i += 16) {
      float16 gx0, gx1, gy0, gy1;
#define AT(k) LOAD(smooth_y + skipped + i + RADIUS + (k))
      SLOPE(float16, gx0, AT, SLOPE_TAPS(taps, 0), 0)
      SLOPE(float16, gx1, AT, SLOPE_TAPS(taps, 1), 1)
#undef AT
#define AT(k) LOAD(slope_y + skipped + i + RADIUS + (k))
      SMOOTH(float16, gy0, AT, SMOOTH_TAPS(taps, 0), 0)
      SMOOTH(float16, gy1, AT, SMOOTH_TAPS(taps, 1), 1)
#undef AT
      STORE(gx0, now + i);
      STORE(gy0, now + line + i);
      STORE(MAGNITUDE(gx0, gy0), now + 2 * line + i);
      STORE(gx1, now + 3 * line + i);
      STORE(gy1, now + 4 * line + i);
      STORE(MAGNITUDE(gx1, gy1), now + 5 * line + i);
    }
    if (row <= begin_y) continue;

    // Maximum test of the row before.
    const int cell_y = row - 1;
    global const float* here = lines + (2 + 6 * ((cell_y + 3) % 3)) * line;
    global const float* above = lines + (2 + 6 * ((cell_y + 2) % 3)) * line;
    global const float* below = now;
    global float* target = winners + (size_t)cell_y * 8 * width;
    int found = 0;
    for (int i = 0; i < pixels; i += 16) {
      const float16 m0 = LOAD(here + 2 * line + i), m1 = LOAD(here + 5 * line + i);
      const int16 pixel = i + (int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
      // Cell 2 (margin + pixel) needs pixel >= 1; either phase needs pixel < pixels - 1.
      int16 win0 = (m0 > threshold) & (pixel >= 1) & (pixel < pixels - 1);
      int16 win1 = (m1 > threshold) & (pixel < pixels - 1);
      if (lane_bits(win0 | win1) == 0) continue;
      const float16 u0 = LOAD(above + 2 * line + i), u1 = LOAD(above + 5 * line + i);
      const float16 d0 = LOAD(below + 2 * line + i), d1 = LOAD(below + 5 * line + i);
      const float16 gx0 = LOAD(here + i), gy0 = LOAD(here + line + i);
      const float16 gx1 = LOAD(here + 3 * line + i), gy1 = LOAD(here + 4 * line + i);
      float16 ahead0, behind0, ahead1, behind1;
      probes16(gx0, gy0, LOAD(here + 5 * line + i - 1), m1, u0, d0, LOAD(above + 5 * line + i - 1), u1,
               LOAD(below + 5 * line + i - 1), d1, &ahead0, &behind0);
      probes16(gx1, gy1, m0, LOAD(here + 2 * line + i + 1), u1, d1, u0, LOAD(above + 2 * line + i + 1), d0,
               LOAD(below + 2 * line + i + 1), &ahead1, &behind1);
      win0 &= IS_MAXIMUM(m0, ahead0, behind0);
      win1 &= IS_MAXIMUM(m1, ahead1, behind1);
      const uint won0 = lane_bits(win0), won1 = lane_bits(win1);
      if ((won0 | won1) == 0) continue;
      uint won = interleave_bits(won0, won1);  // bit n: cell n of the 32
      float ahead[32], behind[32];
      vstore16(ahead0, 0, ahead);
      vstore16(ahead1, 1, ahead);
      vstore16(behind0, 0, behind);
      vstore16(behind1, 1, behind);
      for (; won != 0; won &= won - 1) {
        const int n = lowest_bit(won), lane = n >> 1, phase = n & 1;
        global const float* cell = here + 3 * phase * line + i + lane;
        vstore4(parabola_peak(2 * (margin + i) + n, cell_y, cell[0], cell[line], cell[2 * line],
                              ahead[16 * phase + lane], behind[16 * phase + lane]),
                found++, target);
      }
    }
    counts[cell_y] = found;
  }
}

// The derivatives at (x, y), written to d[0], d[8], d[16] ...: each is the sum of its lanes. The columns of the window
// lie in lanes of 8.
static inline void window_derivatives(global const float* plane, const int stride, const float x, const float y,
                                      float8* d) {
  const int8 lanes = (int8)(0, 1, 2, 3, 4, 5, 6, 7);
  const int whole_x = (int)x, whole_y = (int)y;
  float weights_y[ORDERS][COLUMNS];
  float8 wx[BLOCKS][ORDERS], sums[ORDERS][BLOCKS];
#pragma unroll
  for (int b = 0; b < BLOCKS; ++b) {
    float8 wy[ORDERS];
    weights8(y - (float)whole_y, lanes + 8 * b, wy);
    weights8(x - (float)whole_x, lanes + 8 * b, wx[b]);
#pragma unroll
    for (int order = 0; order < ORDERS; ++order) {
      vstore8(wy[order], b, weights_y[order]);
      sums[order][b] = (float8)0.0f;
    }
  }
  const float8 level = (float8)window_level(plane, stride, whole_x, whole_y);
  global const float* window = WINDOW(plane, stride, whole_x, whole_y);
  for (int k = 0; k < TAPS; ++k, window += stride) {
    float8 grey[BLOCKS];
#pragma unroll
    for (int b = 0; b < BLOCKS; ++b) grey[b] = LOAD8(window + 8 * b) - level;
#pragma unroll
    for (int order = 0; order < ORDERS; ++order) {
      const float8 weight = (float8)weights_y[order][k];
#pragma unroll
      for (int b = 0; b < BLOCKS; ++b) sums[order][b] = fma(weight, grey[b], sums[order][b]);
    }
  }
#define DOT(position, order_x, order_y)                                                                    \
  {                                                                                                        \
    float8 sum_ = wx[0][order_x] * sums[order_y][0];                                                       \
    _Pragma("unroll") for (int b = 1; b < BLOCKS; ++b) sum_ = fma(wx[b][order_x], sums[order_y][b], sum_); \
    d[8 * (position)] = sum_;                                                                              \
  }
  DOT(0, 1, 0)
  DOT(1, 0, 1)
  DOT(2, 2, 0)
  DOT(3, 1, 1)
  DOT(4, 0, 2)
  DOT(5, 3, 0)
  DOT(6, 2, 1)
  DOT(7, 1, 2)
  DOT(8, 0, 3)
  DOT(9, 4, 0)
  DOT(10, 3, 1)
  DOT(11, 2, 2)
  DOT(12, 1, 3)
  DOT(13, 0, 4)
}

// The sums of the lanes of eight vectors.
static inline float8 lane_sums(const float8* v) {
  float8 four[4], two[2];
#pragma unroll
  for (int k = 0; k < 4; ++k) four[k] = (float8)(v[k].lo, v[k + 4].lo) + (float8)(v[k].hi, v[k + 4].hi);
#pragma unroll
  for (int k = 0; k < 2; ++k) {
    const float8 a = four[2 * k], b = four[2 * k + 1];
    two[k] = (float8)(a.s01, b.s01, a.s45, b.s45) + (float8)(a.s23, b.s23, a.s67, b.s67);
  }
  const float8 a = two[0], b = two[1];
  return (float8)(a.s02, b.s02, a.s46, b.s46) + (float8)(a.s13, b.s13, a.s57, b.s57);
}

// Third-order direction and Newton step of the winners, written in their position in scan order.
// One work-item = one row of the doubled grid, 8 edges at a time.
kernel IN_VECTORS void edges_strip_directions(const DetectionArguments args, global const float* plane,
                                              global const float* winners, global const int* counts,
                                              global const int* row_first, global float* edges) {
  const int row = (int)get_global_id(0);
  if (row >= 2 * args.height) return;
  const int stride = args.plane_stride, width = args.width, max_edges = args.max_edges;
  const float newton_max = args.newton_max;
  global float* xs = edges;
  global float* ys = edges + max_edges;
  global float* directions = edges + 2 * max_edges;
  global float* strengths = edges + 3 * max_edges;
  global float* drifts = edges + 4 * max_edges;
  const int first = row_first[row], count = min(counts[row], max_edges - first);
  float8 derivatives[DERIVATIVES * 8];
  float x[8], y[8], theta[8], drift[8];
  for (int k = 0; k < 8 * DERIVATIVES; ++k) derivatives[k] = 0.0f;
  for (int k = 0; k < 8; ++k) x[k] = y[k] = 0.0f;
  for (int begin = 0; begin < count; begin += 8) {
    const int size = min(8, count - begin);
    for (int k = 0; k < size; ++k) {
      const float4 winner = vload4(begin + k, winners + (size_t)row * 8 * width);
      x[k] = winner.x;
      y[k] = winner.y;
      strengths[first + begin + k] = winner.z;
      window_derivatives(plane, stride, AT_CELL ? 0.5f * floor(winner.w) : winner.x,
                         AT_CELL ? 0.5f * (float)row : winner.y, derivatives + k);
    }
    float8 d[DERIVATIVES], edge_x = vload8(0, x), edge_y = vload8(0, y), edge_drift;
    for (int j = 0; j < DERIVATIVES; ++j) d[j] = lane_sums(derivatives + 8 * j);
    vstore8(third_order8(d, newton_max, &edge_x, &edge_y, &edge_drift), 0, theta);
    vstore8(edge_drift, 0, drift);
    vstore8(edge_x, 0, x);
    vstore8(edge_y, 0, y);
    for (int k = 0; k < size; ++k) {
      xs[first + begin + k] = x[k];
      ys[first + begin + k] = y[k];
      directions[first + begin + k] = theta[k];
      drifts[first + begin + k] = drift[k];
    }
  }
}
