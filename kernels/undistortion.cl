// undistortion.cl: the pinhole image of a recorded image with lens distortion.
//
// In: recorded image (source_width x source_height) as corners (pixel_corners.cl), so that a pixel takes one gather; a
// table with the position in it of every pinhole pixel.
// Out: pinhole image (count pixels, packed). One work-item = one pixel, with PIXELS (16) as many in one vector.
// Bilinear, border replicated, rounded half up.
// Reference: host/tracker/geometry/undistortion.cpp.

#if MAX_VALUE > 255
#define OPEN_CORNERS(U, AT, corners, at)                                    \
  const U upper = AT(corners, 2 * (at)), lower = AT(corners, 2 * (at) + 1); \
  const U a = upper & 65535u, b = upper >> 16u, c = lower & 65535u, d = lower >> 16u;
#else
#define OPEN_CORNERS(U, AT, corners, at) \
  const U four = AT(corners, at);        \
  const U a = four & 255u, b = four >> 8u & 255u, c = four >> 16u & 255u, d = four >> 24u;
#endif

// The value at (x, y), between 0 and MAX_VALUE.
#define DEFINE_VALUE_AT(NAME, T, I, U, FLOAT, INT, AS_INT, AT)                                                      \
  static inline I NAME(global const uint* corners, const int width, const int height, const T at_x, const T at_y) { \
    const T x = clamp(at_x, 0.0f, (float)(width - 1)), y = clamp(at_y, 0.0f, (float)(height - 1));                  \
    const I x0 = INT(x), y0 = INT(y);                                                                               \
    const T fx = x - FLOAT(x0), fy = y - FLOAT(y0);                                                                 \
    const I at = y0 * width + x0;                                                                                   \
    OPEN_CORNERS(U, AT, corners, at)                                                                                \
    const T top = (1.0f - fx) * FLOAT(AS_INT(a)) + fx * FLOAT(AS_INT(b));                                           \
    const T bottom = (1.0f - fx) * FLOAT(AS_INT(c)) + fx * FLOAT(AS_INT(d));                                        \
    return INT((1.0f - fy) * top + fy * bottom + 0.5f);                                                             \
  }
#define ONE_AT(p, k) (p)[k]
DEFINE_VALUE_AT(value_at, float, int, uint, convert_float, convert_int, as_int, ONE_AT)

#ifdef PIXELS
DEFINE_VALUE_AT(values_at, float16, int16, uint16, convert_float16, convert_int16, as_int16, gather16)
#if MAX_VALUE > 255
#define STORE_PIXELS(values, pointer) *(global ushort16*)(pointer) = convert_ushort16(values)
#else
#define STORE_PIXELS(values, pointer) *(global uchar16*)(pointer) = convert_uchar16(values)
#endif
#else
#define PIXELS 1
#endif

kernel IN_VECTORS void undistort(global const uint* corners, const int source_width, const int source_height,
                                 global const float* source_x, global const float* source_y, global uchar* image,
                                 const int count) {
  global Pixel* target = (global Pixel*)image;
  const int begin = PIXELS * (int)get_global_id(0), end = min(begin + PIXELS, (int)count);
#if PIXELS > 1
  if (end == begin + PIXELS) {
    STORE_PIXELS(values_at(corners, source_width, source_height, LOAD(source_x + begin), LOAD(source_y + begin)),
                 target + begin);
    return;
  }
#endif
  for (int i = begin; i < end; ++i)
    target[i] = (Pixel)value_at(corners, source_width, source_height, source_x[i], source_y[i]);
}
