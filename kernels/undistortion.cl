// undistortion.cl: the pinhole image of a recorded image with lens distortion.
//
// In: recorded image (source_width x source_height, packed), a table with the position in it of every pinhole pixel.
// Out: pinhole image (count pixels, packed). One work-item = one pixel. Bilinear, border replicated, rounded half up.
// Reference: host/reference/undistortion.cpp.
kernel void undistort(global const uchar* recorded, const int source_width, const int source_height,
                      global const float* source_x, global const float* source_y, global uchar* image,
                      const int count) {
  global const Pixel* source = (global const Pixel*)recorded;
  const int i = (int)get_global_id(0);
  if (i >= count) return;
  const float x = clamp(source_x[i], 0.0f, (float)(source_width - 1));
  const float y = clamp(source_y[i], 0.0f, (float)(source_height - 1));
  const int x0 = (int)x, y0 = (int)y;
  const int x1 = min(x0 + 1, source_width - 1), y1 = min(y0 + 1, source_height - 1);
  const float fx = x - (float)x0, fy = y - (float)y0;
  const float top = (1.0f - fx) * source[y0 * source_width + x0] + fx * source[y0 * source_width + x1];
  const float bottom = (1.0f - fx) * source[y1 * source_width + x0] + fx * source[y1 * source_width + x1];
  ((global Pixel*)image)[i] = (Pixel)((1.0f - fy) * top + fy * bottom + 0.5f);
}
