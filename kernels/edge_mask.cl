// edge_mask.cl: removes the maxima in masked parts of an image. doc/method.md section 1.
//
// In: the maxima of edge_detection_strip.cl (rows: packed at the start of their row) or, with IN_CELLS, of
// edge_detection_tile.cl (flags over the grid), which are thinned out in place; mask = height x width bytes, not 0
// where a pixel is hidden. Cell (X, Y) of the doubled grid belongs to pixel (X / 2, Y / 2).
// Reference: host/reference/edge_mask.cpp.

#ifdef IN_CELLS

// One work-item = one cell of the doubled grid.
kernel void edge_mask_cells(const int width, const int height, global const uchar* mask, global uchar* flags) {
  const int cell = (int)get_global_id(0), row = cell / (2 * width), column = cell % (2 * width);
  if (row >= 2 * height) return;
  if (mask[(size_t)(row / 2) * width + column / 2] != 0) flags[cell] = 0;
}

#else

// One work-item = one row of the doubled grid.
kernel void edge_mask_rows(const int width, const int height, global const uchar* mask, global float* winners,
                           global int* counts) {
  const int row = (int)get_global_id(0);
  if (row >= 2 * height) return;
  global float* maxima = winners + (size_t)row * 8 * width;
  global const uchar* hidden = mask + (size_t)(row / 2) * width;
  const int count = counts[row];
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    const float4 winner = ((global const float4*)maxima)[i];
    if (hidden[(int)winner.w / 2] != 0) continue;
    ((global float4*)maxima)[kept] = winner;
    ++kept;
  }
  counts[row] = kept;
}

#endif
