// smoothing.cl: a noisy image, smoothed in place by the binomial coefficients of order 16 along both axes, which have a
// variance of 4 px^2. Border replicated, rounded half up.
//
// All arithmetic is exact: a row of weights sums to 2^16. One work-item = one pixel.
// Reference: host/workbench/reference/images.cpp.

#define ORDER 16
constant uint kBinomial[ORDER + 1] = {1,     16,   120,  560,  1820, 4368, 8008, 11440, 12870,
                                      11440, 8008, 4368, 1820, 560,  120,  16,   1};

// In: image (width x height, packed). Out: per pixel the sum along its row, times 2^16.
kernel void smooth_rows(global const uchar* bytes, const int width, const int height, global uint* sums) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= width || y >= height) return;
  global const Pixel* row = (global const Pixel*)bytes + y * width;
  uint sum = 0;
  for (int k = 0; k <= ORDER; ++k) sum += kBinomial[k] * (uint)row[clamp(x + k - ORDER / 2, 0, width - 1)];
  sums[y * width + x] = sum;
}

// In: these sums. Out: the smoothed image.
kernel void smooth_columns(global const uint* sums, const int width, const int height, global uchar* bytes) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= width || y >= height) return;
  ulong sum = 1ul << 31;
  for (int k = 0; k <= ORDER; ++k)
    sum += (ulong)kBinomial[k] * sums[clamp(y + k - ORDER / 2, 0, height - 1) * width + x];
  ((global Pixel*)bytes)[y * width + x] = (Pixel)(sum >> 32);
}
