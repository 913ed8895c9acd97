// edge_detection_strip.cl: edge detection for CPUs. One work-item walks along rows, 16 pixels at a time; needs
// edge_detection.cl.

#ifdef __AVX512VL__
#define BLOCKS_AT_ONCE BLOCKS
#else
#define BLOCKS_AT_ONCE 2  // of the third-order sums; those of more take more registers than AVX2 has
#endif

// Gradient and maximum test of strip_rows rows per work-item.
//
// scratch: kStripLines lines of `line` floats per work-item (2 of column sums, then for 3 rows gx, gy and magnitude).
// Out: winners, those of row r from 4 * r * width on, in scan order; counts[r], for all rows.
// LONG: one pass over a strip; its sums stay in registers from row to row.
kernel IN_VECTORS void edges_strip_maxima(const DetectionArguments args, global const float* threshold_of_frame,
                                          const int strip_rows, global const float* plane, global const float* taps,
                                          global float* scratch, const int line, global float* winners,
                                          global int* counts) {
  const int stride = args.plane_stride, width = args.width, height = args.height, margin = args.margin;
  const float threshold = threshold_of_frame[0];
  const int strip = (int)get_global_id(0);
  const int first_row = strip * strip_rows, last_row = min(first_row + strip_rows, height);
  if (first_row >= last_row) return;
  global float* lines = scratch + (size_t)strip * kStripLines * line + kStripLineFront;
  global float* smooth_y = lines;
  global float* slope_y = lines + line;
  // Rows strictly inside the margin; columns strictly inside it and their neighbours.
  const int begin_y = max(first_row, margin + 1), end_y = min(last_row, height - 1 - margin);
  const int columns = width - 2 * margin > 2 ? width - 2 * margin : 0;
  for (int row = first_row; row < last_row; ++row) {
    if (row < begin_y || row >= end_y || columns == 0) counts[row] = 0;
  }
  if (columns == 0) return;
  // Column sums start at the last multiple of 16 floats of the plane that is far enough to the left: aligned vectors
  // take one access to the cache, others two.
  const int skipped = (margin - RADIUS + PAD_X) & 15;

  for (int row = begin_y - 1; row <= end_y; ++row) {
    if (begin_y >= end_y) break;
    // Along y: column sums for the pixels margin - RADIUS - skipped .. width - 1 - margin + RADIUS.
    global const float* source = plane + (row + PAD_Y) * stride + PAD_X + margin - RADIUS - skipped;
    for (int i = 0; i < skipped + columns + 2 * RADIUS; i += 16) {
#define AT(k) LOAD(source + i + (k)*stride)
      float16 g, dg;
      SMOOTH_AND_SLOPE(float16, g, AT, dg, AT, taps)
#undef AT
      STORE(g, smooth_y + i);
      STORE(dg, slope_y + i);
    }
    // Along x: gradient and magnitude.
    global float* now = lines + (2 + 3 * ((row + 3) % 3)) * line;
    for (int i = 0; i < columns; i += 16) {
      float16 gx, gy;
#define SMOOTH_Y(k) LOAD(smooth_y + skipped + i + RADIUS + (k))
#define SLOPE_Y(k) LOAD(slope_y + skipped + i + RADIUS + (k))
      SMOOTH_AND_SLOPE(float16, gy, SLOPE_Y, gx, SMOOTH_Y, taps)
#undef SMOOTH_Y
#undef SLOPE_Y
      STORE(gx, now + i);
      STORE(gy, now + line + i);
      STORE(MAGNITUDE(gx, gy), now + 2 * line + i);
    }
    if (row <= begin_y) continue;

    // Maximum test of the row before.
    const int tested = row - 1;
    global const float* here = lines + (2 + 3 * ((tested + 3) % 3)) * line;
    global const float* above = lines + (4 + 3 * ((tested + 2) % 3)) * line;
    global const float* middle = here + 2 * line;
    global const float* below = now + 2 * line;
    global float* target = winners + (size_t)tested * 4 * width;
    int found = 0;
    for (int i = 0; i < columns; i += 16) {
      const float16 m = LOAD(middle + i);
      uint won = lane_bits(m > threshold);
      if (i == 0) won &= ~1u;
      if (columns - 1 - i < 16) won &= (1u << (uint)(columns - 1 - i)) - 1u;
      if (won == 0) continue;
      float16 ahead16, behind16;
      probes16(LOAD(here + i), LOAD(here + line + i), LOAD(middle + i - 1), LOAD(middle + i + 1), LOAD(above + i),
               LOAD(below + i), LOAD(above + i - 1), LOAD(above + i + 1), LOAD(below + i - 1), LOAD(below + i + 1),
               &ahead16, &behind16);
      won &= lane_bits(m > behind16) & lane_bits(m >= ahead16);  // as IS_MAXIMUM()
      if (won == 0) continue;
      float ahead[16], behind[16];
      vstore16(ahead16, 0, ahead);
      vstore16(behind16, 0, behind);
      for (; won != 0; won &= won - 1) {
        const int lane = lowest_bit(won);
        global const float* at = here + i + lane;
        vstore4(parabola_peak(margin + i + lane, tested, at[0], at[line], at[2 * line], ahead[lane], behind[lane]),
                found++, target);
      }
    }
    counts[tested] = found;
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
#define ADD_BLOCKS(begin, end)                                                                                   \
  for (int k = 0; k < TAPS; ++k) {                                                                               \
    float8 grey[BLOCKS];                                                                                         \
    _Pragma("unroll") for (int b = begin; b < end; ++b) grey[b] = LOAD8(window + k * stride + 8 * b) - level;    \
    _Pragma("unroll") for (int order = 0; order < ORDERS; ++order) {                                             \
      const float8 weight = (float8)weights_y[order][k];                                                         \
      _Pragma("unroll") for (int b = begin; b < end; ++b) sums[order][b] = fma(weight, grey[b], sums[order][b]); \
    }                                                                                                            \
  }
  ADD_BLOCKS(0, min(BLOCKS_AT_ONCE, BLOCKS))
  ADD_BLOCKS(BLOCKS_AT_ONCE, BLOCKS)
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

// Third-order direction and Newton step of the winners, written in their position in scan order.
// One work-item = one row, 8 edges at a time.
kernel IN_VECTORS void edges_strip_directions(const DetectionArguments args, global const float* plane,
                                              global const float* winners, global const int* counts,
                                              global const int* row_first, global float* edges) {
  const int row = (int)get_global_id(0);
  if (row >= args.height) return;
  const int stride = args.plane_stride, width = args.width, max_edges = args.max_edges;
  const float newton_max = args.newton_max;
  global float* xs = edges;
  global float* ys = edges + max_edges;
  global float* directions = edges + 2 * max_edges;
  global float* strengths = edges + 3 * max_edges;
  global float* drifts = edges + 4 * max_edges;
  const int first = row_first[row], count = min(counts[row], max_edges - first);
  float8 derivatives[DERIVATIVES * 8];
  float x[8], y[8], theta[8], strength[8], drift[8];
  for (int k = 0; k < 8 * DERIVATIVES; ++k) derivatives[k] = 0.0f;
  for (int k = 0; k < 8; ++k) x[k] = y[k] = 0.0f;
  for (int begin = 0; begin < count; begin += 8) {
    const int size = min(8, count - begin);
    for (int k = 0; k < size; ++k) {
      const float4 winner = vload4(begin + k, winners + (size_t)row * 4 * width);
      x[k] = winner.x;
      y[k] = winner.y;
      window_derivatives(plane, stride, AT_PIXEL ? winner.z : winner.x, AT_PIXEL ? (float)row : winner.y,
                         derivatives + k);
    }
    float8 d[DERIVATIVES], edge_x = vload8(0, x), edge_y = vload8(0, y), edge_strength, edge_drift;
    for (int j = 0; j < DERIVATIVES; ++j) d[j] = lane_sums(derivatives + 8 * j);
    vstore8(third_order8(d, newton_max, &edge_x, &edge_y, &edge_strength, &edge_drift), 0, theta);
    vstore8(edge_strength, 0, strength);
    vstore8(edge_drift, 0, drift);
    vstore8(edge_x, 0, x);
    vstore8(edge_y, 0, y);
    for (int k = 0; k < size; ++k) {
      xs[first + begin + k] = x[k];
      ys[first + begin + k] = y[k];
      directions[first + begin + k] = theta[k];
      strengths[first + begin + k] = strength[k];
      drifts[first + begin + k] = drift[k];
    }
  }
}
