// pixel_corners.cl: prepares an image for bilinear sampling with one gather per sample.
//
// In: image (width x height, packed). Out: per pixel the four grey levels that bilinear interpolation to its right and
// below needs, one byte each: (x, y), (x+1, y), (x, y+1), (x+1, y+1); border replicated. One work-item = one pixel.

kernel void pixel_corners(global const uchar* image, const int width, const int height, global uint* corners) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= width || y >= height) return;
  const int right = min(x + 1, width - 1);
  global const uchar* above = image + y * width;
  global const uchar* below = image + min(y + 1, height - 1) * width;
  corners[y * width + x] = (uint)above[x] | (uint)above[right] << 8 | (uint)below[x] << 16 | (uint)below[right] << 24;
}
