// undistortion.cl: the pinhole image of a recorded image with lens distortion.
//
// In: recorded image (source_width x source_height) as corners (pixel_corners.cl), so that a pixel takes one gather and
// compilers vectorise; a table with the position in it of every pinhole pixel.
// Out: pinhole image (count pixels, packed). One work-item = one pixel. Bilinear, border replicated, rounded half up.
// Reference: host/reference/images.cpp.
kernel void undistort(global const uint* corners, const int source_width, const int source_height,
                      global const float* source_x, global const float* source_y, global uchar* image,
                      const int count) {
  const int i = (int)get_global_id(0);
  if (i >= count) return;
  const float x = clamp(source_x[i], 0.0f, (float)(source_width - 1));
  const float y = clamp(source_y[i], 0.0f, (float)(source_height - 1));
  const int x0 = (int)x, y0 = (int)y, at = y0 * source_width + x0;
  const float fx = x - (float)x0, fy = y - (float)y0;
#if MAX_VALUE > 255
  const uint upper = corners[2 * at], lower = corners[2 * at + 1];
  const int a = (int)(upper & 65535u), b = (int)(upper >> 16), c = (int)(lower & 65535u), d = (int)(lower >> 16);
#else
  const uint four = corners[at];
  const int a = (int)(four & 255u), b = (int)(four >> 8 & 255u), c = (int)(four >> 16 & 255u), d = (int)(four >> 24);
#endif
  const float top = (1.0f - fx) * (float)a + fx * (float)b, bottom = (1.0f - fx) * (float)c + fx * (float)d;
  ((global Pixel*)image)[i] = (Pixel)(int)((1.0f - fy) * top + fy * bottom + 0.5f);
}
