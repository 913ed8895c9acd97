// undistortion.cl: the pinhole image of a recorded image with lens distortion.
//
// In: recorded image (source_width x source_height, packed), a table with the position in it of every pinhole pixel.
// Out: pinhole image (count pixels, packed). One work-item = one pixel, or with LANES (16) as many pixels in turn: for
// CPUs. Bilinear, border replicated, rounded half up.
// Reference: host/reference/undistortion.cpp.

static inline Pixel undistorted(global const Pixel* source, const int source_width, const int source_height,
                                const float table_x, const float table_y) {
  const float x = clamp(table_x, 0.0f, (float)(source_width - 1));
  const float y = clamp(table_y, 0.0f, (float)(source_height - 1));
  const int x0 = (int)x, y0 = (int)y;
  const int x1 = min(x0 + 1, source_width - 1), y1 = min(y0 + 1, source_height - 1);
  const float fx = x - (float)x0, fy = y - (float)y0;
  const float top = (1.0f - fx) * source[y0 * source_width + x0] + fx * source[y0 * source_width + x1];
  const float bottom = (1.0f - fx) * source[y1 * source_width + x0] + fx * source[y1 * source_width + x1];
  return (Pixel)((1.0f - fy) * top + fy * bottom + 0.5f);
}

#ifdef LANES
// Four bytes at any address: a pixel and the next one.
typedef struct __attribute__((packed)) {
  uint value;
} Word;
#define WORD(k) (((global const Word*)(bytes + (k)))->value)
#define WORDS(k)                                                                                                       \
  (uint16)(WORD(k.s0), WORD(k.s1), WORD(k.s2), WORD(k.s3), WORD(k.s4), WORD(k.s5), WORD(k.s6), WORD(k.s7), WORD(k.s8), \
           WORD(k.s9), WORD(k.sa), WORD(k.sb), WORD(k.sc), WORD(k.sd), WORD(k.se), WORD(k.sf))
#define PIXEL_BITS (8 * (int)sizeof(Pixel))

// Between the pixels `pixel` and their right neighbours.
static inline float16 between(global const uchar* bytes, const int last_word, const int16 pixel, const float16 fx) {
  const int16 wanted = pixel * (int)sizeof(Pixel), at = min(wanted, last_word);
  const uint16 pair = WORDS(at) >> as_uint16(8 * (wanted - at));
  const float16 left = convert_float16(as_int16(pair & (uint16)((1u << PIXEL_BITS) - 1u)));
  const float16 right = convert_float16(as_int16(pair >> PIXEL_BITS & (uint16)((1u << PIXEL_BITS) - 1u)));
  return (1.0f - fx) * left + fx * right;
}

kernel IN_VECTORS void undistort(global const uchar* recorded, const int source_width, const int source_height,
                                 global const float* source_x, global const float* source_y, global uchar* image,
                                 const int count) {
  const int first = LANES * (int)get_global_id(0);
  global Pixel* target = (global Pixel*)image;
  const int last_word = source_width * source_height * (int)sizeof(Pixel) - 4;
  if (first + LANES > count || source_width < 2 || source_height < 2) {
    for (int i = first; i < min(first + LANES, count); ++i)
      target[i] = undistorted((global const Pixel*)recorded, source_width, source_height, source_x[i], source_y[i]);
    return;
  }
  // On the last column and row a pixel lies a whole step from the one before: the same value to the bit.
  const float16 x = clamp(vload16(0, source_x + first), 0.0f, (float)(source_width - 1));
  const float16 y = clamp(vload16(0, source_y + first), 0.0f, (float)(source_height - 1));
  const int16 x0 = min(convert_int16(x), source_width - 2), y0 = min(convert_int16(y), source_height - 2);
  const float16 fx = x - convert_float16(x0), fy = y - convert_float16(y0);
  const int16 pixel = y0 * source_width + x0;
  const float16 top = between(recorded, last_word, pixel, fx),
                bottom = between(recorded, last_word, pixel + source_width, fx);
  const int16 value = convert_int16((1.0f - fy) * top + fy * bottom + 0.5f);
#if WHITE > 255
  vstore16(convert_ushort16(value), 0, target + first);
#else
  vstore16(convert_uchar16(value), 0, target + first);
#endif
}

#else

kernel void undistort(global const uchar* recorded, const int source_width, const int source_height,
                      global const float* source_x, global const float* source_y, global uchar* image,
                      const int count) {
  const int i = (int)get_global_id(0);
  if (i >= count) return;
  ((global Pixel*)image)[i] =
      undistorted((global const Pixel*)recorded, source_width, source_height, source_x[i], source_y[i]);
}

#endif
