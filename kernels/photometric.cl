// photometric.cl: patches on and beside an edge, and their photometric alignment. Functions only.
// Needs direction.cl. Images come as the corners of pixel_corners.cl.
//
// A patch is kPatchRows float8 rows: row i lies i - 2 steps along the tangent, lane j is j - 3 px across it to the
// bright side.
// The eighth lane repeats a sample; it is finite but unused, and sums exclude it.
// Reference: host/workbench/reference/edge_descriptions.cpp.

#define PATCH_REACH 8  // px, more than half the diagonal of a patch

static inline float8 used_lanes(const float8 v) {
  return as_float8(as_int8(v) & (int8)(-1, -1, -1, -1, -1, -1, -1, 0));
}

// Sum of the seven used lanes.
static inline float sum_used(const float8 v) { return sum8(used_lanes(v)); }

// Where a patch lies: its centre and the steps along the tangent.
typedef struct {
  float x, y;
  float cosine, sine;
} PatchFrame;

// `side`: +1 dark, -1 bright, 0 on the edge itself.
static inline PatchFrame patch_frame(const float x, const float y, const float cosine, const float sine,
                                     const float side, const float offset) {
  PatchFrame frame;
  frame.cosine = cosine;
  frame.sine = sine;
  frame.x = x + side * offset * sine;
  frame.y = y - side * offset * cosine;
  return frame;
}

// Grey levels of the four corners of several pixels k: declares a, b, c, d (pixel_corners.cl).
#define CORNER(N, packed, shift, mask) (convert_float##N(as_int##N(packed >> shift & (uint##N)(mask))) * GREY_PER_VALUE)
#if MAX_VALUE > 255
#define CORNERS(N, corners, k)                                                            \
  const int##N above_ = 2 * (k), below_ = above_ + 1;                                     \
  const uint##N upper_ = gather##N(corners, above_), lower_ = gather##N(corners, below_); \
  const float##N a = CORNER(N, upper_, 0u, 65535u), b = CORNER(N, upper_, 16u, 65535u);   \
  const float##N c = CORNER(N, lower_, 0u, 65535u), d = CORNER(N, lower_, 16u, 65535u);
#else
#define CORNERS(N, corners, k)                                                   \
  const uint##N four_ = gather##N(corners, k);                                   \
  const float##N a = CORNER(N, four_, 0u, 255u), b = CORNER(N, four_, 8u, 255u); \
  const float##N c = CORNER(N, four_, 16u, 255u), d = CORNER(N, four_, 24u, 255u);
#endif

// True if no sample of a patch can be outside the image, given the pixel PATCH_REACH up and left of its centre: then
// nothing has to be clamped.
static inline int lies_inside(const int base_x, const int base_y, const int width, const int height) {
  return base_x >= 0 && base_y >= 0 && base_x + 2 * PATCH_REACH < width && base_y + 2 * PATCH_REACH < height;
}

// Mean-free grey levels of a patch moved by (dx, dy); coordinates outside the image are clamped to the border.
INLINED void cut_patch(global const uint* corners, const int width, const int height, const PatchFrame frame,
                       const float dx, const float dy, float8* rows) {
  const float8 across = (float8)(-3.0f, -2.0f, -1.0f, 0.0f, 1.0f, 2.0f, 3.0f, 0.0f);
  const float x = frame.x + dx, y = frame.y + dy;
  // Relative to this pixel all samples inside the image have positive coordinates, so that truncating rounds down.
  const int base_x = (int)x - PATCH_REACH, base_y = (int)y - PATCH_REACH;
  const float8 middle_x = (x - (float)base_x) - across * frame.sine;
  const float8 middle_y = (y - (float)base_y) + across * frame.cosine;
  const float8 low_x = (float)-base_x, high_x = (float)(width - 1 - base_x);
  const float8 low_y = (float)-base_y, high_y = (float)(height - 1 - base_y);
  const int8 stride = width, origin = base_y * width + base_x;
  const int inside = lies_inside(base_x, base_y, width, height);
  float8 sum = 0.0f;
#pragma unroll
  for (int i = 0; i < kPatchRows; ++i) {
    const float along = kPatchRowStep * (float)(i - kPatchRows / 2);
    float8 u = middle_x + along * frame.cosine, v = middle_y + along * frame.sine;
    if (!inside) {
      u = clamp(u, low_x, high_x);
      v = clamp(v, low_y, high_y);
    }
    const int8 u0 = convert_int8(u), v0 = convert_int8(v);
    const float8 fx = u - convert_float8(u0), fy = v - convert_float8(v0);
    const int8 k = origin + v0 * stride + u0;
    CORNERS(8, corners, k)
    const float8 top = a + fx * (b - a), bottom = c + fx * (d - c);
    rows[i] = top + fy * (bottom - top);
  }
  // Subtracting the middle sample first makes a constant patch exactly zero.
  const float middle = rows[kPatchRows / 2].s3;
#pragma unroll
  for (int i = 0; i < kPatchRows; ++i) {
    rows[i] -= middle;
    sum += rows[i];
  }
  const float mean = sum_used(sum) * (1.0f / kPatchSamples);
#pragma unroll
  for (int i = 0; i < kPatchRows; ++i) rows[i] -= mean;
}

// Two patches of one direction at once, as the halves of float16 rows; each the same bits as from cut_patch().
INLINED void cut_two_patches(global const uint* corners, const int width, const int height, const PatchFrame low,
                             const PatchFrame high, float16* rows) {
  const float8 across = (float8)(-3.0f, -2.0f, -1.0f, 0.0f, 1.0f, 2.0f, 3.0f, 0.0f);
  const int low_x = (int)low.x - PATCH_REACH, low_y = (int)low.y - PATCH_REACH;
  const int high_x = (int)high.x - PATCH_REACH, high_y = (int)high.y - PATCH_REACH;
  const float16 middle_x =
      (float16)((low.x - (float)low_x) - across * low.sine, (high.x - (float)high_x) - across * low.sine);
  const float16 middle_y =
      (float16)((low.y - (float)low_y) + across * low.cosine, (high.y - (float)high_y) + across * low.cosine);
  const float16 first_x = (float16)((float8)(-low_x), (float8)(-high_x)),
                first_y = (float16)((float8)(-low_y), (float8)(-high_y));
  const float16 last_x = (float)(width - 1) + first_x, last_y = (float)(height - 1) + first_y;
  const int inside = lies_inside(low_x, low_y, width, height) && lies_inside(high_x, high_y, width, height);
  const int16 stride = width, origin = (int16)((int8)(low_y * width + low_x), (int8)(high_y * width + high_x));
#pragma unroll
  for (int i = 0; i < kPatchRows; ++i) {
    const float along = kPatchRowStep * (float)(i - kPatchRows / 2);
    float16 u = middle_x + along * low.cosine, v = middle_y + along * low.sine;
    if (!inside) {
      u = clamp(u, first_x, last_x);
      v = clamp(v, first_y, last_y);
    }
    const int16 u0 = convert_int16(u), v0 = convert_int16(v);
    const float16 fx = u - convert_float16(u0), fy = v - convert_float16(v0);
    const int16 k = origin + v0 * stride + u0;
    CORNERS(16, corners, k)
    const float16 top = a + fx * (b - a), bottom = c + fx * (d - c);
    rows[i] = top + fy * (bottom - top);
  }
  const float16 middle = (float16)((float8)(rows[kPatchRows / 2].s3), (float8)(rows[kPatchRows / 2].sb));
  float16 sum = 0.0f;
#pragma unroll
  for (int i = 0; i < kPatchRows; ++i) {
    rows[i] -= middle;
    sum += rows[i];
  }
  const float16 mean = (float16)((float8)(sum_used(sum.lo) * (1.0f / kPatchSamples)),
                                 (float8)(sum_used(sum.hi) * (1.0f / kPatchSamples)));
#pragma unroll
  for (int i = 0; i < kPatchRows; ++i) rows[i] -= mean;
}

// Mean-free derivative of a patch along the unit vector (ex, ey), grey levels per px: central difference over 1 px.
static inline void patch_derivative(global const uint* corners, const int width, const int height,
                                    const PatchFrame frame, const float ex, const float ey, float8* rows) {
  PatchFrame ahead = frame, behind = frame;
  ahead.x += 0.5f * ex;
  ahead.y += 0.5f * ey;
  behind.x -= 0.5f * ex;
  behind.y -= 0.5f * ey;
  float16 both[kPatchRows];
  cut_two_patches(corners, width, height, ahead, behind, both);
#pragma unroll
  for (int i = 0; i < kPatchRows; ++i) rows[i] = both[i].lo - both[i].hi;
}

static inline float8 huber_weight(const float8 residual, const float limit) {
  return limit / max(fabs(residual), limit);
}

// Norm of a mean-free patch.
static inline float patch_norm(const float8* rows) {
  float8 squares = 0.0f;
#pragma unroll
  for (int i = 0; i < kPatchRows; ++i) squares += rows[i] * rows[i];
  return sqrt(sum_used(squares));
}

// NCC of two mean-free patches; 0 where one of them is flat.
static inline float rows_ncc(const float8* a, const float norm_a, const float8* b) {
  float8 product = 0.0f;
#pragma unroll
  for (int i = 0; i < kPatchRows; ++i) product += a[i] * b[i];
  const float norms = norm_a * patch_norm(b);
  return norms < 1e-10f ? 0.0f : sum_used(product) / norms;
}

// Results of align_edge().
#define ALIGN_LEFT 0     // the clamp
#define ALIGN_MOVED 1    // after the last step
#define ALIGN_SETTLED 2  // with a step below the tolerance: `values` is the patch that it found

// Gauss-Newton on the move along (ex, ey) that makes the patch at `moving`, at equal contrast, look like `fixed`;
// `derivative` is that of `fixed` along the move. A prior of `stiffness` (grey levels^2 / px^2) holds it around the
// start.
static inline int align_edge(global const uint* corners, const int width, const int height, const PatchFrame moving,
                             const float ex, const float ey, const float8* fixed, const float fixed_norm,
                             const float8* derivative, const float stiffness, const AlignmentSettings settings,
                             float8* values, float* move) {
  float alpha = 0.0f;
  int status = ALIGN_MOVED;
  for (int step = 0; step < settings.steps; ++step) {
    cut_patch(corners, width, height, moving, alpha * ex, alpha * ey, values);
    const float gain = clamp(fixed_norm / fmax(patch_norm(values), 1e-3f), 1.0f / kGainMax, kGainMax);
    float8 curvatures = 0.0f, slopes = 0.0f;
#pragma unroll
    for (int i = 0; i < kPatchRows; ++i) {
      const float8 residual = fixed[i] - gain * values[i];
      const float8 weighted = huber_weight(residual, settings.huber) * derivative[i];
      curvatures += weighted * derivative[i];
      slopes += weighted * residual;
    }
    const float curvature = stiffness + sum_used(curvatures);
    const float change = curvature < 1e-6f ? 0.0f : (sum_used(slopes) - stiffness * alpha) / curvature;
    alpha += change;
    if (!(fabs(alpha) <= settings.clamp)) return ALIGN_LEFT;
    if (fabs(change) < settings.tolerance) {
      status = ALIGN_SETTLED;
      break;
    }
  }
  *move = alpha;
  return status;
}
