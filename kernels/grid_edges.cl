// grid_edges.cl: third-order edges of the paper's method, on a grid of two samples per pixel and axis (doc/paper.md).
//
// Needs edge_detection.cl, whose plane it reads. Cell X of either axis lies at X / 2 px. Even cells are filtered with
// the taps of phase 0, centred on a pixel, odd ones with those of phase 1, centred between two.
// taps: of phase 0, then of phase 1: per order of derivation, 0 to 3, RADIUS + 1 weights for the pairs of pixels at
// j + phase and -j; then, in the same order, COLUMNS weights for the pixels from -RADIUS on.
// Out: edges in blocks of max_edges floats, sorted by the row of the pixel that they lie in, then by x.
// Reference: host/workbench/paper/grid_edges.cpp.

#ifndef STRIP_ROWS
#define STRIP_ROWS 32
#endif

#define FILTERS 4           // orders of derivation along an axis, 0 to 3
#define PAIRS (RADIUS + 1)  // of pixels, of a filter
#define GRID_DERIVATIVES 9  // ix, iy, ixx, ixy, iyy, ixxx, ixxy, ixyy, iyyy

#define PAIR_WEIGHTS(taps, phase, order) ((taps) + (FILTERS * (phase) + (order)) * PAIRS)
#define WINDOW_WEIGHTS(taps, phase, order) ((taps) + 2 * FILTERS * PAIRS + (FILTERS * (phase) + (order)) * COLUMNS)

// The filters along y of a grid row, for `length` pixels from `source` on, which lies in the row's pixel row. sums: one
// line per order.
static inline void filter_columns(global const float* source, const int stride, const int phase,
                                  global const float* taps, const int length, global float* sums, const int line) {
  global const float* weights = PAIR_WEIGHTS(taps, phase, 0);
  for (int i = 0; i < length; i += 16) {
    float16 sum[FILTERS] = {0.0f, 0.0f, 0.0f, 0.0f};
#pragma unroll
    for (int j = 0; j <= RADIUS; ++j) {
      const float16 high = LOAD(source + i + (j + phase) * stride), low = LOAD(source + i - j * stride);
      const float16 same = high + low, turned = high - low;
#pragma unroll
      for (int order = 0; order < FILTERS; ++order)
        sum[order] = fma((float16)(weights[order * PAIRS + j]), (order & 1) != 0 ? turned : same, sum[order]);
    }
#pragma unroll
    for (int order = 0; order < FILTERS; ++order) STORE(sum[order], sums + order * line + i);
  }
}

// A filter along x of an even or odd order, for sixteen cells from pixel `at` on.
static inline float16 even_filter(global const float* at, const int phase, global const float* weights) {
  float16 sum = 0.0f;
#pragma unroll
  for (int j = 0; j <= RADIUS; ++j) sum = fma((float16)(weights[j]), LOAD(at + j + phase) + LOAD(at - j), sum);
  return sum;
}
static inline float16 odd_filter(global const float* at, const int phase, global const float* weights) {
  float16 sum = 0.0f;
#pragma unroll
  for (int j = 0; j <= RADIUS; ++j) sum = fma((float16)(weights[j]), LOAD(at + j + phase) - LOAD(at - j), sum);
  return sum;
}

// Gradient and magnitude of a grid row: three lines per phase. `sums` at the first pixel.
static inline void gradient_along(global const float* sums, global const float* taps, const int columns,
                                  global float* gradient, const int line) {
  for (int i = 0; i < columns; i += 16) {
#pragma unroll
    for (int phase = 0; phase < 2; ++phase) {
      const float16 gx = odd_filter(sums + i, phase, PAIR_WEIGHTS(taps, phase, 1));
      const float16 gy = even_filter(sums + line + i, phase, PAIR_WEIGHTS(taps, phase, 0));
      global float* target = gradient + 3 * phase * line + i;
      STORE(gx, target);
      STORE(gy, target + line);
      STORE(MAGNITUDE(gx, gy), target + 2 * line);
    }
  }
}

// Sixteen cells of one phase: which of them are maxima (lanes of `win` that are not 0), and their edges' positions and
// strengths. here, above, below: lines of gradients at the first of them.
static inline int16 peaks(global const float* here, global const float* above, global const float* below,
                          const int line, const int phase, const int16 win, float16* shift_x, float16* shift_y,
                          float16* strength) {
  const int own = 3 * phase * line, other = 3 * (1 - phase) * line, size = 2 * line;
  const int left = other + size - (phase == 0 ? 1 : 0), right = left + 1;  // neighbours along x are of the other phase
  const float16 gx = LOAD(here + own), gy = LOAD(here + own + line), m = LOAD(here + own + size);
  float16 ahead, behind;
  probes16(gx, gy, LOAD(here + left), LOAD(here + right), LOAD(above + own + size), LOAD(below + own + size),
           LOAD(above + left), LOAD(above + right), LOAD(below + left), LOAD(below + right), &ahead, &behind);
  const float16 rise = ahead - behind;
  const float16 t = -0.5f * rise / ((ahead - m) + (behind - m));
  const float16 scale = 0.5f * t / fmax(fabs(gx), fabs(gy));  // px
  *shift_x = clamp(scale * gx, (float16)-0.25f, (float16)0.25f);
  *shift_y = clamp(scale * gy, (float16)-0.25f, (float16)0.25f);
  *strength = fma(0.25f * t, rise, m);
  return win & (m >= ahead) & (m >= behind) & !((m == ahead) & (m == behind));
}

// Maxima of a row whose directions are computed together.
typedef struct {
  int count;
  int slot[8];  // where they stand in `found`
  int cell[8];  // twice the pixel's index in the lines, plus the phase
} Maxima;

// Directions of the maxima, from the derivatives at their cells. windows: the row's sums along y at the pixel RADIUS
// before the first.
static inline void take_directions(Maxima* maxima, global const float* windows, const int line,
                                   global const float* taps, global float* found) {
  // Orders of derivation along x and y.
  const int order_x[GRID_DERIVATIVES] = {1, 0, 2, 1, 0, 3, 2, 1, 0},
            order_y[GRID_DERIVATIVES] = {0, 1, 0, 1, 2, 0, 1, 2, 3};
  float8 parts[GRID_DERIVATIVES][8], d[GRID_DERIVATIVES];
  for (int k = 0; k < 8; ++k) {
    const int cell = maxima->cell[min(k, maxima->count - 1)];
    global const float* window = windows + cell / 2;
    global const float* weights = WINDOW_WEIGHTS(taps, cell & 1, 0);
    float8 part[GRID_DERIVATIVES];
#pragma unroll
    for (int j = 0; j < GRID_DERIVATIVES; ++j) part[j] = 0.0f;
#pragma unroll
    for (int b = 0; b < BLOCKS; ++b) {
#pragma unroll
      for (int j = 0; j < GRID_DERIVATIVES; ++j)
        part[j] =
            fma(LOAD8(weights + order_x[j] * COLUMNS + 8 * b), LOAD8(window + order_y[j] * line + 8 * b), part[j]);
    }
#pragma unroll
    for (int j = 0; j < GRID_DERIVATIVES; ++j) parts[j][k] = part[j];
  }
#pragma unroll
  for (int j = 0; j < GRID_DERIVATIVES; ++j) d[j] = lane_sums(parts[j]);
  const float8 shared = 2.0f * d[3] * (d[2] + d[4]);
  const float8 xx = d[0] * d[0], xy = 2.0f * d[0] * d[1], yy = d[1] * d[1];
  const float8 fx = 2.0f * d[0] * (d[2] * d[2] + d[3] * d[3]) + d[1] * shared + xx * d[5] + xy * d[6] + yy * d[7];
  const float8 fy = 2.0f * d[1] * (d[4] * d[4] + d[3] * d[3]) + d[0] * shared + xx * d[6] + xy * d[7] + yy * d[8];
  float theta[8];
  vstore8(angle8(fx, -fy), 0, theta);
  for (int k = 0; k < maxima->count; ++k) found[4 * maxima->slot[k] + 2] = theta[k] > -PI_F ? theta[k] : PI_F;
  maxima->count = 0;
}

// Edges of STRIP_ROWS grid rows per work-item; two more are filtered twice.
//
// scratch: kGridLines lines of `line` floats per work-item, zero where nothing was written yet; hidden: height x width
// bytes, not 0 where there are no edges, read if `masked`.
// Out: found: 2 width places of four floats per grid row, x, y, direction, strength, in the order of x: those in the
// pixel row above the next one from the first place on, others (of odd rows) from the last one backwards; counts: how
// many of either.
// LONG: one pass over a strip, whose sums stay in the cache from row to row.
kernel IN_VECTORS void grid_edges_strips(const DetectionArguments args, global const float* threshold_of_frame,
                                         global const float* plane, global const float* taps,
                                         global const uchar* hidden, const int masked, global float* scratch,
                                         const int line, global float* found, global int* counts) {
  const int stride = args.plane_stride, width = args.width, height = args.height, margin = args.margin;
  const float threshold = threshold_of_frame[0];
  const int strip = (int)get_global_id(0);
  const int first_row = strip * STRIP_ROWS, last_row = min(first_row + STRIP_ROWS, 2 * height);
  if (first_row >= last_row) return;
  // Pixels inside the margin, and one to either side.
  const int columns = width - 2 * margin > 0 ? width - 2 * margin + 2 : 0;
  const int begin_y = max(first_row, 2 * margin), end_y = columns > 0 ? min(last_row, 2 * (height - margin)) : 0;
  for (int row = first_row; row < last_row; ++row) counts[2 * row] = counts[2 * row + 1] = 0;
  if (begin_y >= end_y) return;
  const int skipped = (margin - 1 - RADIUS + PAD_X) & 15;  // as in edge_detection_strip.cl
  global float* sums = scratch + (size_t)strip * kGridLines * line + kStripLineFront;
  global float* gradients = sums + 2 * FILTERS * line;
  const int16 lanes = (int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  Maxima maxima;
  maxima.count = 0;
  for (int row = begin_y - 1; row <= end_y; ++row) {
    global float* of_row = sums + FILTERS * (row & 1) * line;
    global float* below = gradients + 6 * ((row + 3) % 3) * line;
    const int pixel_row = (row + 2) / 2 - 1;  // rounded down
    filter_columns(plane + (pixel_row + PAD_Y) * stride + PAD_X + margin - 1 - RADIUS - skipped, stride, row & 1, taps,
                   skipped + columns + 2 * RADIUS + 1, of_row, line);
    gradient_along(of_row + skipped + RADIUS, taps, columns, below, line);
    const int tested = row - 1;
    if (tested < begin_y) continue;
    global const float* here = gradients + 6 * ((tested + 3) % 3) * line;
    global const float* above = gradients + 6 * ((tested + 2) % 3) * line;
    global const float* windows = sums + FILTERS * (tested & 1) * line + skipped;
    global float* places = found + (size_t)tested * 8 * width;
    int front = 0, back = 0;
    for (int i = 0; i < columns; i += 16) {
      const int16 inner = (i + lanes >= 1) & (i + lanes < columns - 1);
      const int16 strong0 = inner & (LOAD(here + 2 * line + i) > threshold),
                  strong1 = inner & (LOAD(here + 5 * line + i) > threshold);
      if (lane_bits(strong0 | strong1) == 0) continue;
      float xs[32], ys[32], strengths[32];
      uint won[2];
#pragma unroll
      for (int phase = 0; phase < 2; ++phase) {
        float16 x, y, strength;
        int16 win =
            peaks(here + i, above + i, below + i, line, phase, phase == 0 ? strong0 : strong1, &x, &y, &strength);
        x += convert_float16(margin - 1 + i + lanes) + 0.5f * (float)phase;
        y += 0.5f * (float)tested;
        win &= (x > (float)margin) & (x < (float)(width - 1 - margin)) & (y > (float)margin) &
               (y < (float)(height - 1 - margin));
        won[phase] = lane_bits(win);
        if (won[phase] == 0) continue;
        vstore16(x, phase, xs);
        vstore16(y, phase, ys);
        vstore16(strength, phase, strengths);
      }
      for (uint left = won[0] | won[1]; left != 0; left &= left - 1) {
        const int lane = lowest_bit(left);
        for (int phase = 0; phase < 2; ++phase) {
          if ((won[phase] >> lane & 1u) == 0) continue;
          const float x = xs[16 * phase + lane], y = ys[16 * phase + lane];
          if (masked && hidden[(int)(y + 0.5f) * width + (int)(x + 0.5f)] != 0) continue;
          const int is_next = (tested & 1) != 0 && y >= 0.5f * (float)tested;
          const int slot = is_next ? 2 * width - 1 - back++ : front++;
          vstore4((float4)(x, y, 0.0f, strengths[16 * phase + lane]), slot, places);
          maxima.slot[maxima.count] = slot;
          maxima.cell[maxima.count] = 2 * (i + lane) + phase;
          if (++maxima.count == 8) take_directions(&maxima, windows, line, taps, places);
        }
      }
    }
    if (maxima.count > 0) take_directions(&maxima, windows, line, taps, places);
    counts[2 * tested] = front;
    counts[2 * tested + 1] = back;
  }
}

// Edges per pixel row. One work-item = one row.
kernel void grid_edges_count(const int height, global const int* counts, global int* of_rows) {
  const int row = (int)get_global_id(0);
  if (row >= height) return;
  of_rows[row] = (row > 0 ? counts[2 * (2 * row - 1) + 1] : 0) + counts[4 * row] + counts[4 * row + 2];
}

// Merges the three lists of a pixel row by x; of equal ones the upper grid row's is first. One work-item = one row.
kernel void grid_edges_merge(const DetectionArguments args, global const float* found, global const int* counts,
                             global const int* row_first, global float* edges) {
  const int row = (int)get_global_id(0);
  if (row >= args.height) return;
  const int places = 2 * args.width, max_edges = args.max_edges;
  global const float4* of_row = (global const float4*)found + (size_t)(2 * row) * places;
  global const float4* next[3] = {of_row - 1, of_row, of_row + places};
  const int step[3] = {-1, 1, 1};
  int left[3] = {row > 0 ? counts[2 * (2 * row - 1) + 1] : 0, counts[4 * row], counts[4 * row + 2]};
  const int end = min(row_first[row + 1], max_edges);
  for (int i = row_first[row]; i < end; ++i) {
    int chosen = -1;
    float lowest = INFINITY;
#pragma unroll
    for (int k = 0; k < 3; ++k) {
      if (left[k] == 0 || !(next[k][0].x < lowest)) continue;
      chosen = k;
      lowest = next[k][0].x;
    }
    const float4 edge = next[chosen][0];
    next[chosen] += step[chosen];
    --left[chosen];
    edges[i] = edge.x;
    edges[max_edges + i] = edge.y;
    edges[2 * max_edges + i] = edge.z;
    edges[3 * max_edges + i] = edge.w;
    edges[4 * max_edges + i] = 0.0f;
  }
}
