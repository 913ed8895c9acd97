// pixel_corners.cl: prepares an image for bilinear sampling with one gather per sample.
//
// In: image (width x height, packed). Out: per pixel the four values that bilinear interpolation to its right and below
// needs: (x, y), (x+1, y), (x, y+1), (x+1, y+1), one byte each, or in images of 16 bits one word each; border
// replicated. One work-item = one pixel.

kernel void pixel_corners(global const uchar* bytes, const int width, const int height, global uint* corners) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= width || y >= height) return;
  const int right = min(x + 1, width - 1);
  global const Pixel* above = (global const Pixel*)bytes + y * width;
  global const Pixel* below = (global const Pixel*)bytes + min(y + 1, height - 1) * width;
#if MAX_VALUE > 255
  corners[2 * (y * width + x)] = (uint)above[x] | (uint)above[right] << 16;
  corners[2 * (y * width + x) + 1] = (uint)below[x] | (uint)below[right] << 16;
#else
  corners[y * width + x] = (uint)above[x] | (uint)above[right] << 8 | (uint)below[x] << 16 | (uint)below[right] << 24;
#endif
}
