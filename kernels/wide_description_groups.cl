// wide_description_groups.cl: the description of wide_description.cl with sixteen work-items per row, one per cell, for
// GPUs; samples and bins are kept in local memory.
//
// Needs direction.cl and wide_samples.cl before it. In and out as there, and the same bits: every sum is taken in
// the same order. Groups of GROUP work-items. Reference: host/workbench/reference/edge_descriptions.cpp.

#define CELLS (kWideCells * kWideCells)
#define ROWS_PER_GROUP (GROUP / CELLS)
#define SAMPLE_SIDE (SIDE + 2)

// Sum over the cells of a row, in their order.
static inline float sum_of_cells(local float* shares, const int cell, const float share) {
  shares[cell] = share;
  barrier(CLK_LOCAL_MEM_FENCE);
  float sum = 0.0f;
  for (int k = 0; k < CELLS; ++k) sum += shares[k];
  barrier(CLK_LOCAL_MEM_FENCE);
  return sum;
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void wide_describe(
    global const float* small, const int small_width, const int small_height, global const float* edges,
    const int stride, const int rows, const int step, global uchar* descriptors) {
  local float samples_of_rows[ROWS_PER_GROUP][SAMPLE_SIDE * SAMPLE_SIDE];
  local float8 bins_of_rows[ROWS_PER_GROUP][CELLS];  // of the samples of one line; the last one has no meaning
  local float shares_of_rows[ROWS_PER_GROUP][CELLS];
  const int cell = (int)get_local_id(0) % CELLS, row_of_group = (int)get_local_id(0) / CELLS;
  const int wanted = (int)get_global_id(0) / CELLS;
  const int row = min(wanted, rows - 1);  // surplus work-items work along with the last row for the barriers
  local float* samples = samples_of_rows[row_of_group];
  local float8* bins = bins_of_rows[row_of_group];
  const int edge = row * step;
  float cosine;
  const float sine = sine_cosine(edges[2 * stride + edge], &cosine);
  const float x = (edges[edge] - 0.5f * (kWideShrink - 1)) / kWideShrink,
              y = (edges[stride + edge] - 0.5f * (kWideShrink - 1)) / kWideShrink;
  for (int k = cell; k < SAMPLE_SIDE * SAMPLE_SIDE; k += CELLS) {
    const float along = (float)(k % SAMPLE_SIDE - HALF - 1), across = (float)(k / SAMPLE_SIDE - HALF - 1);
    samples[k] = wide_sample(small, small_width, small_height, x + along * cosine - across * sine,
                             y + along * sine + across * cosine);
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  float8 histogram = 0.0f;
#pragma unroll 1
  for (int v = 0; v < SIDE; ++v) {
    local const float* p = samples + (v + 1) * SAMPLE_SIDE + min(cell, SIDE - 1) + 1;
    bins[cell] = wide_bins(p[1] - p[-1], p[SAMPLE_SIDE] - p[-SAMPLE_SIDE]);
    barrier(CLK_LOCAL_MEM_FENCE);
    float8 line = 0.0f;
#pragma unroll 1
    for (int u = 0; u < SIDE; ++u) line += wide_weight(u - HALF, cell % kWideCells) * bins[u];
    histogram += wide_weight(v - HALF, cell / kWideCells) * line;
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  local float* shares = shares_of_rows[row_of_group];
  const float clip = CLIP * sqrt(sum_of_cells(shares, cell, sum8(histogram * histogram)));
  histogram = min(histogram, clip);
  const float norm = sqrt(sum_of_cells(shares, cell, sum8(histogram * histogram)));
  const float scale = norm > 0.0f ? NORM / norm : 0.0f;
  if (wanted < rows)
    ((global uchar8*)(descriptors + (size_t)row * kWideBytes))[cell] =
        convert_uchar8(convert_int8(min(histogram * scale, 255.0f) + 0.5f));
}
