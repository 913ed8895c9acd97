// wide_description.cl: what surrounds an edge, as one descriptor of 36 x 36 px turned with the edge, for finding it
// anywhere.
//
// wide_shrink    In: image (width x height, packed). Out: means of blocks of kWideShrink x kWideShrink pixels,
// small_width x small_height.
//                One work-item = one block.
// wide_describe  In: that image, stereo edges packed as stereo_collect writes them (the left blocks are used). Row r
//                belongs to edge r * step. Out: 128 bytes per row, laid out as in host/reference/wide_description.hpp.
//                One work-item = one row.
// Needs direction.cl before it. Reference: host/reference/wide_description.cpp.

#define HALF 7  // samples on either side of the middle one
#define SIDE (2 * HALF + 1)
#define CELL_WIDTH 3.0f  // small pixels
#define CLIP 0.2f
#define NORM 512.0f

// Cosine and sine of the middles of the angle bins.
constant float8 kCosine = (float8)(1.0f, 0.707106781f, 0.0f, -0.707106781f, -1.0f, -0.707106781f, 0.0f, 0.707106781f);
constant float8 kSine = (float8)(0.0f, 0.707106781f, 1.0f, 0.707106781f, 0.0f, -0.707106781f, -1.0f, -0.707106781f);
// exp(-k^2 / 72), k = 0 .. 7: the window's Gaussian has a standard deviation of 2 cells.
constant float kWindow[HALF + 1] = {1.0f,         0.986207117f, 0.945959469f, 0.882496903f,
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

inline float wide_sample(global const float* small, const int width, const int height, const float x, const float y) {
  const float column = clamp(x, 0.0f, (float)(width - 1)), row = clamp(y, 0.0f, (float)(height - 1));
  const int x0 = (int)column, y0 = (int)row;
  const int x1 = min(x0 + 1, width - 1), y1 = min(y0 + 1, height - 1);
  const float fx = column - (float)x0, fy = row - (float)y0;
  const float top = (1.0f - fx) * small[y0 * width + x0] + fx * small[y0 * width + x1];
  const float bottom = (1.0f - fx) * small[y1 * width + x0] + fx * small[y1 * width + x1];
  return (1.0f - fy) * top + fy * bottom;
}

// Weight that a sample `offset` small pixels from the middle has in a cell, along one axis.
inline float wide_weight(const int offset, const int cell) {
  const float distance = fabs((float)offset * (1.0f / CELL_WIDTH) - ((float)cell - 0.5f * (kWideCells - 1)));
  return max(0.0f, 1.0f - distance) * kWindow[abs(offset)];
}

inline float wide_sum(const float8 v) {
  const float4 four = v.lo + v.hi;
  const float2 two = four.lo + four.hi;
  return two.x + two.y;
}

kernel void wide_describe(global const float* small, const int small_width, const int small_height,
                          global const float* edges, const int stride, const int rows, const int step,
                          global uchar* descriptors) {
  const int row = (int)get_global_id(0);
  if (row >= rows) return;
  const int edge = row * step;
  float cosine;
  const float sine = sine_cosine(edges[2 * stride + edge], &cosine);
  const float x = (edges[edge] - 0.5f * (kWideShrink - 1)) / kWideShrink,
              y = (edges[stride + edge] - 0.5f * (kWideShrink - 1)) / kWideShrink;

  float samples[(SIDE + 2) * (SIDE + 2)];
  for (int v = 0; v < SIDE + 2; ++v) {
    for (int u = 0; u < SIDE + 2; ++u) {
      const float along = (float)(u - HALF - 1), across = (float)(v - HALF - 1);
      samples[v * (SIDE + 2) + u] = wide_sample(small, small_width, small_height, x + along * cosine - across * sine,
                                                y + along * sine + across * cosine);
    }
  }
  float8 histogram[kWideCells * kWideCells];
  for (int cell = 0; cell < kWideCells * kWideCells; ++cell) histogram[cell] = 0.0f;
  for (int v = 0; v < SIDE; ++v) {
    float8 line[kWideCells];
    for (int cell = 0; cell < kWideCells; ++cell) line[cell] = 0.0f;
    for (int u = 0; u < SIDE; ++u) {
      const float* p = samples + (v + 1) * (SIDE + 2) + u + 1;
      const float gradient_along = p[1] - p[-1], gradient_across = p[SIDE + 2] - p[-(SIDE + 2)];
      const float square = gradient_along * gradient_along + gradient_across * gradient_across;
      const float8 part = max(gradient_along * kCosine + gradient_across * kSine, 0.0f);
      const float8 bins = square > 0.0f ? part * part * part / square : 0.0f;
      for (int cell = 0; cell < kWideCells; ++cell) line[cell] += wide_weight(u - HALF, cell) * bins;
    }
    for (int cell = 0; cell < kWideCells * kWideCells; ++cell)
      histogram[cell] += wide_weight(v - HALF, cell / kWideCells) * line[cell % kWideCells];
  }
  float squares = 0.0f;
  for (int cell = 0; cell < kWideCells * kWideCells; ++cell) squares += wide_sum(histogram[cell] * histogram[cell]);
  const float clip = CLIP * sqrt(squares);
  squares = 0.0f;
  for (int cell = 0; cell < kWideCells * kWideCells; ++cell) {
    histogram[cell] = min(histogram[cell], clip);
    squares += wide_sum(histogram[cell] * histogram[cell]);
  }
  const float norm = sqrt(squares), scale = norm > 0.0f ? NORM / norm : 0.0f;
  global uchar* descriptor = descriptors + (size_t)row * kWideBytes;
  for (int cell = 0; cell < kWideCells * kWideCells; ++cell) {
    vstore8(convert_uchar8(convert_int8(min(histogram[cell] * scale, 255.0f) + 0.5f)), cell, descriptor);
  }
}
