// edge_detection.cl: third-order edges: the code shared by edge_detection_strip.cl (for CPUs) and
// edge_detection_tile.cl (for GPUs).
//
// doc/method.md section 1; reference: host/workbench/reference/edge_detection.cpp. Both forms give the same bytes,
// because every number is computed by the macros and functions of this file in one order of operations. fma rounds
// once, in vectors and scalars alike; exp and atan2 are written out for the same reason.
//
// Data: plane = the image as floats with replicated border (padded_plane.cl); pixel (i, j) lies at
// (j + PAD_Y) * stride + i + PAD_X.
// taps = RADIUS + 1 weights of G, then of G', for the pairs of pixels at k and -k.
// winners = 4 floats per pixel that won the maximum test: x, y, the pixel's column, direction_code() of its gradient.

#ifndef RADIUS
#define RADIUS 8
#define SIGMA 2.0f
#endif
#ifndef AT_PIXEL
#define AT_PIXEL 0
#endif

#define TAPS (2 * RADIUS + 2)    // per axis around an edge: at least RADIUS to either side
#define BLOCKS ((TAPS + 7) / 8)  // the taps along x in lanes of 8
#define COLUMNS (8 * BLOCKS)
#define PAD_X (16 * ((RADIUS + 18) / 16))
#define PAD_Y (RADIUS + 2)

// smooth = sum over k of the weights of G * (SMOOTHED(k) + SMOOTHED(-k)), slope = that of the weights of G' *
// (SLOPED(k) - SLOPED(-k)), in this order; macro(k) is the sample k pixels further on. In one loop, so that samples of
// both sums are read once and few are held at a time.
#define SMOOTH_AND_SLOPE(T, smooth, SMOOTHED, slope, SLOPED, taps)           \
  {                                                                          \
    T even_ = (T)((taps)[0]) * SMOOTHED(0), odd_ = (T)0.0f;                  \
    _Pragma("unroll") for (int k = 1; k <= RADIUS; ++k) {                    \
      even_ = fma((T)((taps)[k]), SMOOTHED(k) + SMOOTHED(-k), even_);        \
      odd_ = fma((T)((taps)[RADIUS + 1 + k]), SLOPED(k) - SLOPED(-k), odd_); \
    }                                                                        \
    smooth = even_;                                                          \
    slope = odd_;                                                            \
  }

// Gradient magnitude one step ahead of and behind a pixel along its gradient, on the ring of its eight neighbours
// (l, r, u, d: left, right, up, down).
#define DEFINE_PROBES(NAME, T)                                                                                        \
  static inline void NAME(const T gx, const T gy, const T l, const T r, const T u, const T d, const T ul, const T ur, \
                          const T dl, const T dr, T* ahead, T* behind) {                                              \
    const T ax = fabs(gx), ay = fabs(gy);                                                                             \
    const T q = fmin(ax, ay) / fmax(ax, ay);                                                                          \
    const T axis_ahead = ax >= ay ? (gx > 0.0f ? r : l) : (gy > 0.0f ? d : u);                                        \
    const T axis_behind = ax >= ay ? (gx > 0.0f ? l : r) : (gy > 0.0f ? u : d);                                       \
    const T diagonal_ahead = gy > 0.0f ? (gx > 0.0f ? dr : dl) : (gx > 0.0f ? ur : ul);                               \
    const T diagonal_behind = gy > 0.0f ? (gx > 0.0f ? ul : ur) : (gx > 0.0f ? dl : dr);                              \
    *ahead = fma(q, diagonal_ahead - axis_ahead, axis_ahead);                                                         \
    *behind = fma(q, diagonal_behind - axis_behind, axis_behind);                                                     \
  }
DEFINE_PROBES(probes, float)
DEFINE_PROBES(probes16, float16)

#define MAGNITUDE(gx, gy) sqrt(fma(gy, gy, (gx) * (gx)))

// Of equal neighbours along the gradient, only the first one is a maximum.
#define IS_MAXIMUM(m, ahead, behind) (((m) > (behind)) & ((m) >= (ahead)))

// The line along a gradient in steps of 0.2 degrees: one of 1024 codes, the upper half of which says |gx| >= |gy|, the
// lower bits the ratio of the smaller to the larger component.
static inline float direction_code(const float gx, const float gy) {
  const int steep = fabs(gx) >= fabs(gy);
  const float ratio = (steep ? gy : gx) / (steep ? gx : gy);
  const float code = ((ratio + 1.0f) * 255.5f + 12582912.0f) - 12582912.0f; /* rounds to a whole number */
  return (steep ? 512.0f : 0.0f) + code;
}

// Peak of the parabola through the three values. The probes lie magnitude / max(|gx|, |gy|) pixels away, which cancels.
static inline float4 parabola_peak(const int column, const int row, const float gx, const float gy,
                                   const float magnitude, const float ahead, const float behind) {
  const float rise = ahead - behind;
  const float t = -0.5f * rise / ((ahead - magnitude) + (behind - magnitude));
  const float scale = t / fmax(fabs(gx), fabs(gy));
  return (float4)(fma(scale, gx, (float)column), fma(scale, gy, (float)row), (float)column, direction_code(gx, gy));
}

// Weights of G and its derivatives up to the fourth at point - pixel for the pixels index = 0 .. TAPS - 1, which lie at
// index - RADIUS from the point's whole part; `fraction` is the rest. Zero beyond TAPS.
#define DEFINE_WEIGHTS(NAME, T, I, CONVERT_I, CONVERT_T, AS_T)                                                \
  static inline void NAME(const float fraction, const I index, T* g) {                                        \
    const float ss = SIGMA * SIGMA;                                                                           \
    const T u = fraction - CONVERT_T(index - RADIUS);                                                         \
    const T uu = u * u;                                                                                       \
    const T e = uu * (-0.5f / ss);                                                                            \
    const T n = fma(e, (T)1.44269504f, (T)12582912.0f) - 12582912.0f; /* rounds to a whole number */          \
    const T r = fma(n, (T)-1.42860677e-6f, fma(n, (T)-0.693145752f, e));                                      \
    T p = fma(r, (T)1.38888889e-3f, (T)8.33333333e-3f);                                                       \
    p = fma(r, p, (T)4.16666667e-2f);                                                                         \
    p = fma(r, p, (T)1.66666667e-1f);                                                                         \
    p = fma(r, p, (T)0.5f);                                                                                   \
    p = fma(r, p, (T)1.0f);                                                                                   \
    p = fma(r, p, (T)1.0f);                                                                                   \
    const T value = p * AS_T((CONVERT_I(n) + 127) << 23) * (0.398942280f / SIGMA);                            \
    g[0] = index < TAPS ? value : (T)0.0f;                                                                    \
    g[1] = g[0] * u * (-1.0f / (SIGMA * SIGMA));                                                              \
    g[2] = g[0] * (uu - SIGMA * SIGMA) * (1.0f / (SIGMA * SIGMA * SIGMA * SIGMA));                            \
    g[3] = g[0] * u * (3.0f * SIGMA * SIGMA - uu) * (1.0f / (SIGMA * SIGMA * SIGMA * SIGMA * SIGMA * SIGMA)); \
    g[4] = g[0] * fma(uu, uu - 6.0f * ss, (T)(3.0f * ss * ss)) * (1.0f / (ss * ss * ss * ss));                \
  }
DEFINE_WEIGHTS(weights, float, int, convert_int, convert_float, as_float)
DEFINE_WEIGHTS(weights8, float8, int8, convert_int8, convert_float8, as_float8)

// First pixel of the third-order window around the point whose whole part is (x, y).
#define WINDOW(plane, stride, x, y) ((plane) + ((y)-RADIUS + PAD_Y) * (stride) + (x)-RADIUS + PAD_X)

// Grey level that the third-order window is taken relative to: mean of the four pixels around the point.
static inline float window_level(global const float* plane, const int stride, const int x, const int y) {
  global const float* at = plane + (y + PAD_Y) * stride + x + PAD_X;
  return 0.25f * ((at[0] + at[1]) + (at[stride] + at[stride + 1]));
}

// The sums of the lanes of eight vectors.
static inline float8 lane_sums(const float8* v) {
  float8 four[4], two[2];
#pragma unroll
  for (int k = 0; k < 4; ++k) four[k] = (float8)(v[k].lo, v[k + 4].lo) + (float8)(v[k].hi, v[k + 4].hi);
#pragma unroll
  for (int k = 0; k < 2; ++k) {
    const float8 a = four[2 * k], b = four[2 * k + 1];
    two[k] = (float8)(a.s01, b.s01, a.s45, b.s45) + (float8)(a.s23, b.s23, a.s67, b.s67);
  }
  const float8 a = two[0], b = two[1];
  return (float8)(a.s02, b.s02, a.s46, b.s46) + (float8)(a.s13, b.s13, a.s57, b.s57);
}

// atan2 in [-pi, pi], to 2e-7; polynomial of atan(a) / a on [0, 1] fitted for the smallest largest error.
#define DEFINE_ANGLE(NAME, T)                                  \
  static inline T NAME(const T y, const T x) {                 \
    const T ax = fabs(x), ay = fabs(y);                        \
    const T high = fmax(ax, ay);                               \
    const T a = high > 0.0f ? fmin(ax, ay) / high : (T)0.0f;   \
    const T t = a * a;                                         \
    T p = fma(t, (T)-0.00490985345f, (T)0.025035454f);         \
    p = fma(t, p, (T)-0.0606097877f);                          \
    p = fma(t, p, (T)0.0999545604f);                           \
    p = fma(t, p, (T)-0.140503764f);                           \
    p = fma(t, p, (T)0.199756086f);                            \
    p = fma(t, p, (T)-0.333324641f);                           \
    const T eighth = fma(a * t, p, a);                         \
    const T quarter = ay > ax ? 0.5f * PI_F - eighth : eighth; \
    return copysign(x < 0.0f ? PI_F - quarter : quarter, y);   \
  }

#define DERIVATIVES \
  14              // of the window: ix, iy, ixx, ixy, iyy, ixxx, ixxy, ixyy, iyyy, ixxxx, ixxxy, ixxyy, ixyyy, iyyyy
#define ORDERS 5  // of derivation along one axis, 0 to 4

// From the derivatives d at (x, y) to the direction; to the Newton step onto F = 0, which moves x and y; to the
// gradient magnitude; and to how far the edge drifts towards its bright side per unit of log(SIGMA), by the heat
// equation.
#define DEFINE_THIRD_ORDER(NAME, T, ANGLE)                                                                             \
  static inline T NAME(const T* d, const float newton_max, T* x, T* y, T* strength, T* drift) {                        \
    const T shared = 2.0f * d[3] * (d[2] + d[4]);                                                                      \
    const T xx = d[0] * d[0], xy = 2.0f * d[0] * d[1], yy = d[1] * d[1];                                               \
    const T fx = 2.0f * d[0] * (d[2] * d[2] + d[3] * d[3]) + d[1] * shared + xx * d[5] + xy * d[6] + yy * d[7];        \
    const T fy = 2.0f * d[1] * (d[4] * d[4] + d[3] * d[3]) + d[0] * shared + xx * d[6] + xy * d[7] + yy * d[8];        \
    const T theta = ANGLE(fx, -fy);                                                                                    \
    const T slope = fx * d[0] + fy * d[1]; /* times |grad I| */                                                        \
    const T f = xx * d[2] + xy * d[3] + yy * d[4];                                                                     \
    const T magnitude = MAGNITUDE(d[0], d[1]);                                                                         \
    *strength = magnitude;                                                                                             \
    const T longest = (T)newton_max;                                                                                   \
    const T step = slope < 0.0f ? clamp(-f * magnitude / slope, -longest, longest) / magnitude : (T)0.0f;              \
    *x = fma(step, d[0], *x);                                                                                          \
    *y = fma(step, d[1], *y);                                                                                          \
    const T change_x = d[5] + d[7], change_y = d[6] + d[8]; /* the Laplacian's own derivatives */                      \
    const T squared = magnitude * magnitude;                                                                           \
    const T by_scale = 2.0f * (d[0] * d[2] + d[1] * d[3]) * change_x + 2.0f * (d[0] * d[3] + d[1] * d[4]) * change_y + \
                       xx * (d[9] + d[11]) + xy * (d[10] + d[12]) + yy * (d[11] + d[13]);                              \
    /* Of F / |grad I|^2, whose changes hardly depend on how near F = 0 they are taken. */                             \
    const T shift = by_scale - 2.0f * f * (d[0] * change_x + d[1] * change_y) / squared;                               \
    const T fall = slope - 2.0f * f * f / squared;                                                                     \
    const T far = (T)kLongestScaleDrift;                                                                               \
    *drift = slope < 0.0f && fall < 0.0f ? clamp(-SIGMA * SIGMA * shift * magnitude / fall, -far, far) : (T)0.0f;      \
    return theta > -PI_F ? theta : (T)PI_F;                                                                            \
  }
DEFINE_ANGLE(angle, float)
DEFINE_ANGLE(angle8, float8)
DEFINE_THIRD_ORDER(third_order, float, angle)
DEFINE_THIRD_ORDER(third_order8, float8, angle8)
