// edge_mask.cl: removes the maxima in masked parts of an image. doc/method.md section 1.
//
// In: the maxima of edge_detection_strip.cl (rows: packed at the start of their row) or, with AT_PIXELS, of
// edge_detection_tile.cl (flags over the image), which are thinned out in place; mask = height x width bytes, not 0
// where a pixel is hidden.
// Reference: host/workbench/reference/edge_detection.cpp.

#ifdef AT_PIXELS

// One work-item = one pixel.
kernel void edge_mask_pixels(const int pixels, global const uchar* mask, global uchar* flags) {
  const int pixel = (int)get_global_id(0);
  if (pixel < pixels && mask[pixel] != 0) flags[pixel] = 0;
}

#else

// One work-item = one row.
kernel void edge_mask_rows(const int width, const int height, global const uchar* mask, global float* winners,
                           global int* counts) {
  const int row = (int)get_global_id(0);
  if (row >= height) return;
  global float* maxima = winners + (size_t)row * 4 * width;
  global const uchar* hidden = mask + (size_t)row * width;
  const int count = counts[row];
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    const float4 winner = ((global const float4*)maxima)[i];
    if (hidden[(int)winner.z] != 0) continue;
    ((global float4*)maxima)[kept] = winner;
    ++kept;
  }
  counts[row] = kept;
}

#endif
