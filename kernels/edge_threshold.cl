// edge_threshold.cl: the threshold of a frame's edges, from the contrast and the noise of its images (doc/method.md
// section 1). Needs edge_detection.cl, whose taps and padded plane it reads.
//
// An image is tallied at lattice points kThresholdStep px apart, in the middle of square cells: the magnitude of the
// gradient at the point, and the responses of the noise operator along the point's row. A tally is kThresholdBins
// integers, first those of the gradient, then those of the noise; every row of the lattice has its own tally, so that
// the result does not depend on the order of work-items. Reference: host/workbench/reference/edge_detection.cpp.
//
// GROUP 1: one work-item tallies a row of the lattice with float16. Otherwise a group tallies a row, as many points at
// a time as it has work-items for the columns of pixels around them.

#ifndef GROUP
#define GROUP 1
#endif

#define HALF_STEP (kThresholdStep / 2)
#if GROUP == 1
#define FORM IN_VECTORS
#define POINTS 8  // of the lattice at once
#define TALLY global
#define COLUMN private
#define COUNT(bin) ++tally[bin]
#else
#define FORM __attribute__((reqd_work_group_size(GROUP, 1, 1)))
#define POINTS (GROUP > 2 * RADIUS ? (GROUP - 2 * RADIUS - 1) / kThresholdStep + 1 : 1)
#define TALLY local
#define COLUMN local
#define COUNT(bin) atomic_inc(tally + (bin))
#endif
#define WINDOW_COLUMNS ((POINTS - 1) * kThresholdStep + 2 * RADIUS + 1)  // that the points' gradients need

// Eight bins per octave: exponent and three bits of the mantissa.
static inline int gradient_bin(const float magnitude) {
  return clamp((as_int(magnitude) >> 20) - kGradientBinsFrom, 0, kGradientBins - 1);
}
static inline float gradient_bin_start(const int bin) {
  return bin == 0 ? 0.0f : as_float((bin + kGradientBinsFrom) << 20);
}

// Integers below 16 have one bin each, larger ones, from 2^4 on, eight bins per octave as above.
static inline int noise_bin(const int response) {
  return min(response < 16 ? response : (as_int((float)response) >> 20) - 8 * (127 + 4) + 16, kNoiseBins - 1);
}
static inline int noise_bin_start(const int bin) { return bin < 16 ? bin : (8 + (bin & 7)) << (bin / 8 - 1); }

// The noise operator, [1 -2 1] along both axes, in steps of the recorded image's levels; negative where one of the nine
// pixels is black or white, and at the image's border.
#define DEFINE_NOISE(NAME, T, I, CONVERT, AT)                                                 \
  static inline I NAME(global const float* pixel, const I x, const ThresholdArguments args) { \
    T sum = 0.0f, low = args.max_grey, high = 0.0f;                                           \
    for (int row = -1; row <= 1; ++row) {                                                     \
      global const float* middle = pixel + row * args.plane_stride;                           \
      const T a = AT(middle - 1), b = AT(middle), c = AT(middle + 1);                         \
      sum += (row == 0 ? -2.0f : 1.0f) * ((a - b) - (b - c));                                 \
      low = fmin(low, fmin(a, fmin(b, c)));                                                   \
      high = fmax(high, fmax(a, fmax(b, c)));                                                 \
    }                                                                                         \
    const I counts = (x > 0) & (x < args.width - 1) & (low > 0.0f) & (high < args.max_grey);  \
    return counts ? CONVERT(fabs(sum) / args.quantum + 0.5f) : (I)(-1);                       \
  }
#define ONE(pointer) (*(pointer))
DEFINE_NOISE(noise_response, float, int, (int), ONE)
#if GROUP == 1
DEFINE_NOISE(noise_response16, float16, int16, convert_int16, LOAD)
#endif

// Tallies the gradient at a pixel, from what the columns around it sum up to along y, RADIUS of them on either side.
static inline void tally_gradient(const float grey, COLUMN const float* smooth_y, COLUMN const float* slope_y,
                                  const ThresholdArguments args, global const float* taps, TALLY int* tally) {
  if (grey <= 0.0f || grey >= args.max_grey) return;
  float gx, gy;
#define SMOOTH_Y(k) smooth_y[RADIUS + (k)]
#define SLOPE_Y(k) slope_y[RADIUS + (k)]
  SMOOTH_AND_SLOPE(float, gy, SLOPE_Y, gx, SMOOTH_Y, taps)
#undef SMOOTH_Y
#undef SLOPE_Y
  COUNT(gradient_bin(MAGNITUDE(gx, gy)));
}

#if GROUP == 1

// Tallies the gradient at `points` points, the first one `pixel` points at.
static inline void tally_gradients(global const float* pixel, const int points, const ThresholdArguments args,
                                   global const float* taps, TALLY int* tally) {
  float smooth_y[WINDOW_COLUMNS + 15], slope_y[WINDOW_COLUMNS + 15];
#define AT(k) LOAD(pixel + i - RADIUS + (k)*args.plane_stride)
  for (int i = 0; i < WINDOW_COLUMNS; i += 16) {
    float16 g, dg;
    SMOOTH_AND_SLOPE(float16, g, AT, dg, AT, taps)
    vstore16(g, 0, smooth_y + i);
    vstore16(dg, 0, slope_y + i);
  }
#undef AT
  for (int n = 0; n < points; ++n) {
    const int column = n * kThresholdStep;
    tally_gradient(pixel[column], smooth_y + column, slope_y + column, args, taps, tally);
  }
}

// Tallies the noise operator in the row of pixels through the cells of `points` points.
static inline void tally_noise(global const float* row, const int first_x, const int points,
                               const ThresholdArguments args, TALLY int* tally) {
  const int16 lanes = (int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  for (int x = first_x; x < first_x + points * kThresholdStep; x += 16) {
    int responses[16];
    vstore16(noise_response16(row + x, x + lanes, args), 0, responses);
    const int size = min(16, first_x + points * kThresholdStep - x);
    for (int k = 0; k < size; ++k)
      if (responses[k] >= 0) COUNT(kGradientBins + noise_bin(responses[k]));
  }
}

#else

// The same by all work-items of the group: a column each, which they share, then a point.
static inline void tally_gradients(global const float* pixel, const int points, const ThresholdArguments args,
                                   global const float* taps, local float* smooth_y, local float* slope_y,
                                   TALLY int* tally) {
  const int item = (int)get_local_id(0), columns = (points - 1) * kThresholdStep + 2 * RADIUS + 1;
  barrier(CLK_LOCAL_MEM_FENCE);  // all work-items have read the previous columns
#define AT(k) ONE(pixel + i - RADIUS + (k)*args.plane_stride)
  for (int i = item; i < columns; i += GROUP) {
    SMOOTH_AND_SLOPE(float, smooth_y[i], AT, slope_y[i], AT, taps)
  }
#undef AT
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int n = item; n < points; n += GROUP) {
    const int column = n * kThresholdStep;
    tally_gradient(pixel[column], smooth_y + column, slope_y + column, args, taps, tally);
  }
}

// One pixel per work-item.
static inline void tally_noise(global const float* row, const int first_x, const int points,
                               const ThresholdArguments args, TALLY int* tally) {
  for (int x = first_x + (int)get_local_id(0); x < first_x + points * kThresholdStep; x += GROUP) {
    const int response = noise_response(row + x, x, args);
    if (response >= 0) COUNT(kGradientBins + noise_bin(response));
  }
}

#endif

// One work-group = one row of the lattice. Out: its tally, number first_tally + group.
kernel FORM void edges_tally(const ThresholdArguments args, global const float* plane, global const float* taps,
                             const int first_tally, global int* tallies) {
  const int item = (int)get_local_id(0), lattice_row = (int)get_group_id(0);
  global int* result = tallies + (first_tally + lattice_row) * kThresholdBins;
#if GROUP == 1
  global int* tally = result;
#else
  local int tally[kThresholdBins];
  local float smooth_y[WINDOW_COLUMNS], slope_y[WINDOW_COLUMNS];
#endif
  for (int bin = item; bin < kThresholdBins; bin += GROUP) tally[bin] = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  const int y = lattice_row * kThresholdStep + HALF_STEP, points = args.width / kThresholdStep;
  global const float* row = plane + (y + PAD_Y) * args.plane_stride + PAD_X;
  for (int first = 0; first < points; first += POINTS) {
    const int count = min(POINTS, points - first), x = first * kThresholdStep;
#if GROUP == 1
    tally_gradients(row + x + HALF_STEP, count, args, taps, tally);
#else
    tally_gradients(row + x + HALF_STEP, count, args, taps, smooth_y, slope_y, tally);
#endif
    tally_noise(row, x, count, args, tally);
  }
#if GROUP != 1
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int bin = item; bin < kThresholdBins; bin += GROUP) result[bin] = tally[bin];
#endif
}

// The magnitude that `wanted` of the gradients exceed.
static inline float gradient_exceeded_by(local const int* tally, const float wanted) {
  float above = 0.0f;
  for (int bin = kGradientBins - 1; bin >= 0; --bin) {
    const float here = (float)tally[bin];
    if (here > 0.0f && above + here >= wanted) {
      const float start = gradient_bin_start(bin), end = gradient_bin_start(bin + 1);
      return end - (end - start) * ((wanted - above) / here);
    }
    above += here;
  }
  return 0.0f;
}

// Median of the noise operator's responses in steps; an integer represents half a step to either side.
static inline float noise_median(local const int* tally, const float total) {
  float below = 0.0f;
  for (int bin = 0; bin < kNoiseBins; ++bin) {
    const float here = (float)tally[kGradientBins + bin];
    if (here > 0.0f && below + here >= 0.5f * total) {
      const float start = fmax((float)noise_bin_start(bin) - 0.5f, 0.0f);
      const float end = (float)noise_bin_start(bin + 1) - 0.5f;
      return start + (end - start) * ((0.5f * total - below) / here);
    }
    below += here;
  }
  return 0.0f;
}

// From the tallies of both images to the threshold. One group. result = threshold [grey levels per px], which it keeps
// from frame to frame as long as it stays within kThresholdHold of what is measured; standard deviation of the noise
// [grey levels], or known_noise unless that is negative; gradient that args.area of the images exceed.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void edges_threshold(const ThresholdArguments args,
                                                                               global const int* tallies,
                                                                               const int count, const float known_noise,
                                                                               global float* result) {
  local int sums[kThresholdBins];
  const int item = (int)get_local_id(0);
  for (int bin = item; bin < kThresholdBins; bin += GROUP) {
    int sum = 0;
    for (int n = 0; n < count; ++n) sum += tallies[n * kThresholdBins + bin];
    sums[bin] = sum;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item != 0) return;
  float gradients = 0.0f, responses = 0.0f;
  for (int bin = 0; bin < kGradientBins; ++bin) gradients += (float)sums[bin];
  for (int bin = kGradientBins; bin < kThresholdBins; ++bin) responses += (float)sums[bin];
  const float noise = known_noise >= 0.0f ? known_noise : args.quantum * noise_median(sums, responses) / kNoiseMedian;
  const float gradient = gradients > 0.0f ? gradient_exceeded_by(sums, args.area * gradients) : args.highest;
  const float contrast = gradient * gradient / args.highest;
  const float measured = fmin(fmax(contrast, fmax(args.per_noise * noise, args.lowest)), args.highest);
  const float before = result[0];
  const bool held = before <= kThresholdHold * measured && measured <= kThresholdHold * before;
  result[0] = held ? before : measured;
  result[1] = noise;
  result[2] = gradient;
}
