// wide_samples.cl: what the descriptions of wide_description.cl are made of.
//
// wide_shrink    In: image (width x height, packed). Out: means of blocks of kWideShrink x kWideShrink pixels,
// small_width x small_height. One work-item = one block.
// Reference: host/workbench/reference/edge_descriptions.cpp.

#define HALF 7  // samples on either side of the middle one
#define SIDE (2 * HALF + 1)
#define WIDE_CELL_WIDTH 3.0f  // small pixels
#define CLIP 0.2f
#define NORM 512.0f

// Cosine and sine of the middles of the angle bins.
constant float8 kCosine = (float8)(1.0f, 0.707106781f, 0.0f, -0.707106781f, -1.0f, -0.707106781f, 0.0f, 0.707106781f);
constant float8 kSine = (float8)(0.0f, 0.707106781f, 1.0f, 0.707106781f, 0.0f, -0.707106781f, -1.0f, -0.707106781f);
// exp(-k^2 / 72), k = 0 .. 7: the window's Gaussian has a standard deviation of 2 cells.
constant float kWideWindow[HALF + 1] = {1.0f,         0.986207117f, 0.945959469f, 0.882496903f,
                                        0.800737403f, 0.706648277f, 0.60653066f,  0.50633562f};

kernel void wide_shrink(global const uchar* bytes, const int width, const int small_width, const int small_height,
                        global float* small) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= small_width || y >= small_height) return;
  global const Pixel* image = (global const Pixel*)bytes;
  int sum = 0;
  for (int row = 0; row < kWideShrink; ++row)
    for (int column = 0; column < kWideShrink; ++column)
      sum += image[(kWideShrink * y + row) * width + kWideShrink * x + column];
  small[y * small_width + x] = (float)sum / (float)(kWideShrink * kWideShrink) * GREY_PER_VALUE;
}

static inline float wide_sample(global const float* small, const int width, const int height, const float x,
                                const float y) {
  const float column = clamp(x, 0.0f, (float)(width - 1)), row = clamp(y, 0.0f, (float)(height - 1));
  const int x0 = (int)column, y0 = (int)row;
  const int x1 = min(x0 + 1, width - 1), y1 = min(y0 + 1, height - 1);
  const float fx = column - (float)x0, fy = row - (float)y0;
  const float top = (1.0f - fx) * small[y0 * width + x0] + fx * small[y0 * width + x1];
  const float bottom = (1.0f - fx) * small[y1 * width + x0] + fx * small[y1 * width + x1];
  return (1.0f - fy) * top + fy * bottom;
}

// Weight that a sample `offset` small pixels from the middle has in a cell, along one axis.
static inline float wide_weight(const int offset, const int cell) {
  const float distance = fabs((float)offset * (1.0f / WIDE_CELL_WIDTH) - ((float)cell - 0.5f * (kWideCells - 1)));
  return max(0.0f, 1.0f - distance) * kWideWindow[abs(offset)];
}

// What a gradient gives to the angle bins.
static inline float8 wide_bins(const float along, const float across) {
  const float square = along * along + across * across;
  const float8 part = max(along * kCosine + across * kSine, 0.0f);
  return square > 0.0f ? part * part * part / square : 0.0f;
}
