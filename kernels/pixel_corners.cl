// pixel_corners.cl: prepares an image for bilinear sampling with one gather per sample.
//
// In: image (width x height, packed). Out: per pixel the four values that bilinear interpolation to its right and below
// needs: (x, y), (x+1, y), (x, y+1), (x+1, y+1), one byte each, or in images of 16 bits one word each; border
// replicated. One work-item = 16 neighbouring pixels.

// Vectors at any address, see common.cl.
typedef struct __attribute__((packed)) {
  uchar16 lanes;
} PackedBytes;
typedef struct __attribute__((packed)) {
  uint16 lanes;
} PackedWords;
#define BYTES(pointer) convert_uint16(((global const PackedBytes*)(pointer))->lanes)

kernel void pixel_corners(global const uchar* bytes, const int width, const int height, global uint* corners) {
  const int x = 16 * (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= width || y >= height) return;
  global const Pixel* above = (global const Pixel*)bytes + y * width + x;
  global const Pixel* below = (global const Pixel*)bytes + min(y + 1, height - 1) * width + x;
#if MAX_VALUE > 255
  global uint* target = corners + 2 * (y * width + x);
#else
  global uint* target = corners + y * width + x;
  if (x + 16 < width) {
    ((global PackedWords*)target)->lanes =
        BYTES(above) | BYTES(above + 1) << 8u | BYTES(below) << 16u | BYTES(below + 1) << 24u;
    return;
  }
#endif
  for (int k = 0; k < min(16, width - x); ++k) {
    const int right = min(k + 1, width - 1 - x);
#if MAX_VALUE > 255
    target[2 * k] = (uint)above[k] | (uint)above[right] << 16;
    target[2 * k + 1] = (uint)below[k] | (uint)below[right] << 16;
#else
    target[k] = (uint)above[k] | (uint)above[right] << 8 | (uint)below[k] << 16 | (uint)below[right] << 24;
#endif
  }
}
