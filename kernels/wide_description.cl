// wide_description.cl: what surrounds an edge, as one descriptor of 36 x 36 px turned with the edge, for finding it
// anywhere.
//
// In: the image of wide_shrink, stereo edges packed as stereo_collect writes them (the left blocks are used). Row r
// belongs to edge r * step. Out: 128 bytes per row, laid out as in host/workbench/reference/edge_descriptions.hpp.
// One work-item = one row.
// Needs direction.cl and wide_samples.cl before it. Reference: host/workbench/reference/edge_descriptions.cpp.

kernel IN_VECTORS void wide_describe(global const float* small, const int small_width, const int small_height,
                                     global const float* edges, const int stride, const int rows, const int step,
                                     global uchar* descriptors) {
  const int row = (int)get_global_id(0);
  if (row >= rows) return;
  const int edge = row * step;
  float cosine;
  const float sine = sine_cosine(edges[2 * stride + edge], &cosine);
  const float x = (edges[edge] - 0.5f * (kWideShrink - 1)) / kWideShrink,
              y = (edges[stride + edge] - 0.5f * (kWideShrink - 1)) / kWideShrink;

  float samples[(SIDE + 2) * (SIDE + 2)];
  for (int v = 0; v < SIDE + 2; ++v) {
    for (int u = 0; u < SIDE + 2; ++u) {
      const float along = (float)(u - HALF - 1), across = (float)(v - HALF - 1);
      samples[v * (SIDE + 2) + u] = wide_sample(small, small_width, small_height, x + along * cosine - across * sine,
                                                y + along * sine + across * cosine);
    }
  }
  float8 histogram[kWideCells * kWideCells];
  for (int cell = 0; cell < kWideCells * kWideCells; ++cell) histogram[cell] = 0.0f;
  // Unrolled, so that weights are constants and the half of them that are zero are left out.
  for (int v = 0; v < SIDE; ++v) {
    float8 line[kWideCells];
    for (int cell = 0; cell < kWideCells; ++cell) line[cell] = 0.0f;
#pragma unroll
    for (int u = 0; u < SIDE; ++u) {
      const float* p = samples + (v + 1) * (SIDE + 2) + u + 1;
      const float8 bins = wide_bins(p[1] - p[-1], p[SIDE + 2] - p[-(SIDE + 2)]);
#pragma unroll
      for (int cell = 0; cell < kWideCells; ++cell)
        if (wide_weight(u - HALF, cell) > 0.0f) line[cell] += wide_weight(u - HALF, cell) * bins;
    }
    for (int row_of_cells = 0; row_of_cells < kWideCells; ++row_of_cells) {
      const float weight = wide_weight(v - HALF, row_of_cells);
      if (weight == 0.0f) continue;
#pragma unroll
      for (int cell = 0; cell < kWideCells; ++cell) histogram[row_of_cells * kWideCells + cell] += weight * line[cell];
    }
  }
  float squares = 0.0f;
  for (int cell = 0; cell < kWideCells * kWideCells; ++cell) squares += sum8(histogram[cell] * histogram[cell]);
  const float clip = CLIP * sqrt(squares);
  squares = 0.0f;
  for (int cell = 0; cell < kWideCells * kWideCells; ++cell) {
    histogram[cell] = min(histogram[cell], clip);
    squares += sum8(histogram[cell] * histogram[cell]);
  }
  const float norm = sqrt(squares), scale = norm > 0.0f ? NORM / norm : 0.0f;
  global uchar* descriptor = descriptors + (size_t)row * kWideBytes;
  for (int cell = 0; cell < kWideCells * kWideCells; ++cell) {
    vstore8(convert_uchar8(convert_int8(min(histogram[cell] * scale, 255.0f) + 0.5f)), cell, descriptor);
  }
}
