// edge_detection_tile.cl: edge detection for GPUs. One work-group per tile, per row or for a few edges; needs
// edge_detection.cl.

#ifndef LOCAL
#define LOCAL 64
#define TILE_X 16
#define TILE_Y 16
#endif

#define OF_GROUP __attribute__((reqd_work_group_size(LOCAL, 1, 1)))
#define RING_X (TILE_X + 2)  // the tile's pixels and one more on either side
#define RING_Y (TILE_Y + 2)
#define TILE_COLUMNS (RING_X + 2 * RADIUS)        // sums along y that these pixels need
#define RING_PIXELS (2 * RING_X + 2 * TILE_Y)     // pixels around the tile's
#define PIXELS_OF_ITEM (TILE_X * TILE_Y / LOCAL)  // of the tile's, each work-item's own

// x, y = the gradient of pixel (column, row) of a tile with its ring, from the sums along y. A macro, because PoCL 3.1
// passes wrong local arrays to functions that are called twice.
#define TILE_GRADIENT(x, y, row, column)                   \
  {                                                        \
    const int at = (row)*TILE_COLUMNS + (column) + RADIUS; \
    SMOOTH_AND_SLOPE(float, y, SLOPE_Y, x, SMOOTH_Y, taps) \
  }
#define SMOOTH_Y(k) smooth_y[at + (k)]
#define SLOPE_Y(k) slope_y[at + (k)]

// Gradient and maximum test of TILE_X x TILE_Y pixels per work-group of LOCAL.
//
// Out: flags, height x width: 1 for maxima; winners: the maxima, at the position of their pixel (4 * (r * width + x)).
kernel OF_GROUP void edges_tile_maxima(const DetectionArguments args, global const float* threshold_of_frame,
                                       const int tiles_x, global const float* plane, global const float* taps,
                                       global float* winners, global uchar* flags) {
  local float smooth_y[RING_Y * TILE_COLUMNS], slope_y[RING_Y * TILE_COLUMNS];
  local float magnitude[RING_Y * RING_X];
  float2 gradients[PIXELS_OF_ITEM];  // in registers: in local memory they would reduce occupancy
  const int stride = args.plane_stride, width = args.width, height = args.height, margin = args.margin;
  const float threshold = threshold_of_frame[0];
  const int item = (int)get_local_id(0);
  const int x0 = ((int)get_group_id(0) % tiles_x) * TILE_X, y0 = ((int)get_group_id(0) / tiles_x) * TILE_Y;

  // Along y: rows y0 - 1 .. y0 + TILE_Y, columns from x0 - 1 - RADIUS on. Sums beyond the plane belong to no pixel of
  // the image.
  for (int i = item; i < RING_Y * TILE_COLUMNS; i += LOCAL) {
    const int y = min(y0 - 1 + i / TILE_COLUMNS, height), x = min(x0 - 1 - RADIUS + i % TILE_COLUMNS, width + RADIUS);
    global const float* source = plane + (y + PAD_Y) * stride + x + PAD_X;
#define AT(k) source[(k)*stride]
    SMOOTH_AND_SLOPE(float, smooth_y[i], AT, slope_y[i], AT, taps)
#undef AT
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  // Along x: the tile's pixels, then those around them.
  _Pragma("unroll") for (int n = 0; n < PIXELS_OF_ITEM; ++n) {
    const int i = n * LOCAL + item, row = i / TILE_X + 1, column = i % TILE_X + 1;
    TILE_GRADIENT(gradients[n].x, gradients[n].y, row, column)
    magnitude[row * RING_X + column] = MAGNITUDE(gradients[n].x, gradients[n].y);
  }
  for (int i = item; i < RING_PIXELS; i += LOCAL) {
    const int side = i - 2 * RING_X;  // above and below, then left and right
    const int row = side < 0 ? i / RING_X * (RING_Y - 1) : side / 2 + 1;
    const int column = side < 0 ? i % RING_X : side % 2 * (RING_X - 1);
    float2 gradient;
    TILE_GRADIENT(gradient.x, gradient.y, row, column)
    magnitude[row * RING_X + column] = MAGNITUDE(gradient.x, gradient.y);
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  _Pragma("unroll") for (int n = 0; n < PIXELS_OF_ITEM; ++n) {
    const int i = n * LOCAL + item, row = i / TILE_X, column = i % TILE_X;
    const int x = x0 + column, y = y0 + row;
    if (x >= width || y >= height) continue;
    const int at = (row + 1) * RING_X + column + 1;
    const float gx = gradients[n].x, gy = gradients[n].y;
    uchar won = 0;
    if (x > margin && x < width - 1 - margin && y > margin && y < height - 1 - margin && magnitude[at] > threshold) {
      float ahead, behind;
      local const float* m = magnitude + at;
      probes(gx, gy, m[-1], m[1], m[-RING_X], m[RING_X], m[-RING_X - 1], m[-RING_X + 1], m[RING_X - 1], m[RING_X + 1],
             &ahead, &behind);
      if (IS_MAXIMUM(m[0], ahead, behind)) {
        won = 1;
        ((global float4*)winners)[(size_t)y * width + x] = parabola_peak(x, y, gx, gy, m[0], ahead, behind);
      }
    }
    flags[(size_t)y * width + x] = won;
  }
}

// counts[row] = winners of the row. One work-group per row.
kernel OF_GROUP void edges_tile_count(global const uchar* flags, const int width, global int* counts) {
  local int sums[LOCAL];
  const int item = (int)get_local_id(0), row = (int)get_group_id(0);
  int sum = 0;
  for (int i = item; i < width; i += LOCAL) sum += flags[(size_t)row * width + i];
  sums[item] = sum;
  for (int distance = LOCAL / 2; distance > 0; distance /= 2) {
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < distance) sums[item] += sums[item + distance];
  }
  if (item == 0) counts[row] = sums[0];
}

// Moves the winners of a row to their position in scan order, as far as the capacity reaches; rows[position] = row.
// One work-group per row.
kernel OF_GROUP void edges_tile_compact(global const uchar* flags, const int width, global const float* winners,
                                        global const int* row_first, const int max_edges, global float* compact,
                                        global int* rows) {
  local int sums[LOCAL];
  const int item = (int)get_local_id(0), row = (int)get_group_id(0);
  int base = row_first[row];
  for (int begin = 0; begin < width; begin += LOCAL) {
    const int i = begin + item;
    const int won = i < width ? flags[(size_t)row * width + i] : 0;
    sums[item] = won;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int step = 1; step < LOCAL; step *= 2) {
      const int other = item >= step ? sums[item - step] : 0;
      barrier(CLK_LOCAL_MEM_FENCE);
      sums[item] += other;
      barrier(CLK_LOCAL_MEM_FENCE);
    }
    const int position = base + sums[item] - won;
    if (won && position < max_edges) {
      ((global float4*)compact)[position] = ((global const float4*)winners)[(size_t)row * width + i];
      rows[position] = row;
    }
    base += sums[LOCAL - 1];
    barrier(CLK_LOCAL_MEM_FENCE);
  }
}

// Third-order direction and Newton step. 8 work-items per edge: lane l sums the columns l, l + 8, l + 16 ... of the
// window. The host does not know the number of edges: as many groups as the device can run at once share them.
// LONG: one edge from window to position, in a loop.
kernel OF_GROUP void edges_tile_directions(const DetectionArguments args, global const float* plane,
                                           global const float* compact, global const int* rows, global const int* total,
                                           global float* edges) {
  // Weights along y of each edge's [ORDERS][COLUMNS], then sums [DERIVATIVES][LOCAL].
  local float shared[LOCAL * (ORDERS * COLUMNS > 8 * DERIVATIVES ? ORDERS * COLUMNS / 8 : DERIVATIVES)];
  const int item = (int)get_local_id(0), lane = item & 7, group = item >> 3;
  const int stride = args.plane_stride, count = total[0], step = (int)get_num_groups(0) * (LOCAL / 8);
  local float* weights_y = shared + group * ORDERS * COLUMNS;
  local float* sums = shared;
  for (int first = (int)get_group_id(0) * (LOCAL / 8); first < count; first += step) {
    const int n = first + group;
    const bool active = n < count;
    const float4 winner = active ? ((global const float4*)compact)[n] : (float4)0.0f;
    const float x = AT_PIXEL ? winner.z : winner.x, y = AT_PIXEL ? (float)(active ? rows[n] : 0) : winner.y;
    const int whole_x = (int)x, whole_y = (int)y;
    for (int k = lane; k < COLUMNS; k += 8) {
      float w[ORDERS];
      weights(y - (float)whole_y, k, w);
      for (int order = 0; order < ORDERS; ++order) weights_y[order * COLUMNS + k] = w[order];
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const float level = window_level(plane, stride, whole_x, whole_y);
    global const float* window = WINDOW(plane, stride, whole_x, whole_y);
    float s[DERIVATIVES];
    for (int column = lane; column < COLUMNS; column += 8) {
      float d[ORDERS] = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
      // Fully unrolled it needs 170 registers on AMD.
      _Pragma("unroll 6") for (int k = 0; k < TAPS; ++k) {
        const float grey = window[k * stride + column] - level;
        for (int order = 0; order < ORDERS; ++order) d[order] = fma(weights_y[order * COLUMNS + k], grey, d[order]);
      }
      float w[ORDERS];
      weights(x - (float)whole_x, column, w);
      const float wx[DERIVATIVES] = {w[1], w[0], w[2], w[1], w[0], w[3], w[2],
                                     w[1], w[0], w[4], w[3], w[2], w[1], w[0]};
      const float dy[DERIVATIVES] = {d[0], d[1], d[0], d[1], d[2], d[0], d[1],
                                     d[2], d[3], d[0], d[1], d[2], d[3], d[4]};
      for (int j = 0; j < DERIVATIVES; ++j) s[j] = column < 8 ? wx[j] * dy[j] : fma(wx[j], dy[j], s[j]);
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // all work-items have read the weights
    for (int j = 0; j < DERIVATIVES; ++j) sums[j * LOCAL + item] = s[j];
    for (int distance = 4; distance > 0; distance /= 2) {
      barrier(CLK_LOCAL_MEM_FENCE);
      if (lane < distance) {
        for (int j = 0; j < DERIVATIVES; ++j) sums[j * LOCAL + item] += sums[j * LOCAL + item + distance];
      }
    }
    if (active && lane == 0) {
      float d[DERIVATIVES], edge_x = winner.x, edge_y = winner.y, strength, drift;
      for (int j = 0; j < DERIVATIVES; ++j) d[j] = sums[j * LOCAL + item];
      edges[2 * args.max_edges + n] = third_order(d, args.newton_max, &edge_x, &edge_y, &strength, &drift);
      edges[n] = edge_x;
      edges[args.max_edges + n] = edge_y;
      edges[3 * args.max_edges + n] = strength;
      edges[4 * args.max_edges + n] = drift;
    }
    barrier(CLK_LOCAL_MEM_FENCE);  // all work-items have read the sums
  }
}
