// photometric_lanes.cl: photometric.cl with one work-item per lane of a patch, which holds the samples of its
// column.
// Functions only. Needs photometric.cl; all results have the same bits as there.
//
// Eight neighbouring work-items share a patch; a group of GROUP works on GROUP / kPatchLanes patches. The samples
// of the eighth lane are unused. All work-items of a group must call the functions that take an Exchange, because they
// contain barriers. Where a function takes `wanted`, patches without it only take part in the barriers.

#ifndef GROUP
#define GROUP 64
#endif
#define EXCHANGE_FLOATS (4 * GROUP)

// Exchange of two floats per work-item through local memory. Two halves are used alternately, so that one barrier per
// exchange suffices: before a half is written again, all work-items have passed the barrier of the other half and thus
// have read it.
typedef struct {
  local float* memory;  // EXCHANGE_FLOATS
  int turn;             // half to be written next
} Exchange;

// Returns the values of all work-items: `a` of work-item k at k, `b` at GROUP + k. Valid until the next exchange.
static inline local const float* tell(Exchange* exchange, const float a, const float b) {
  const int item = (int)get_local_id(0);
  local float* told = exchange->memory + exchange->turn * 2 * GROUP;
  exchange->turn ^= 1;
  told[item] = a;
  told[GROUP + item] = b;
  barrier(CLK_LOCAL_MEM_FENCE);
  return told;
}

static inline int lane_of_item(void) { return (int)get_local_id(0) & (kPatchLanes - 1); }
static inline int patch_in_group(void) { return (int)get_local_id(0) / kPatchLanes; }

// The lanes of the work-item's patch.
static inline float8 patch_lanes(Exchange* exchange, const float value) {
  return vload8(patch_in_group(), tell(exchange, value, 0.0f));
}

// Sums over the used lanes of the work-item's patch.
static inline float sum_lanes(Exchange* exchange, const float value) { return sum_used(patch_lanes(exchange, value)); }
static inline float2 sum_two_lanes(Exchange* exchange, const float a, const float b) {
  local const float* told = tell(exchange, a, b);
  return (float2)(sum_used(vload8(patch_in_group(), told)), sum_used(vload8(patch_in_group(), told + GROUP)));
}

// True if the first lane of any patch of the group has published an `a` other than 0.
static inline int any_patch(local const float* told) {
  int any = 0;
  for (int k = 0; k < GROUP; k += kPatchLanes) any |= told[k] != 0.0f;
  return any;
}

// Grey level of a corner (pixel_corners.cl).
static inline float corner_grey(global const uint* corners, const int pixel, const int corner) {
#if MAX_VALUE > 255
  return (float)(int)(corners[2 * pixel + corner / 2] >> (16 * (corner & 1)) & 65535u) * GREY_PER_VALUE;
#else
  return (float)(int)(corners[pixel] >> (8 * corner) & 255u) * GREY_PER_VALUE;
#endif
}

// A column of cut_patch().
static inline void cut_column(global const uint* corners, const int width, const int height, const PatchFrame frame,
                              const int wanted, Exchange* exchange, float* column) {
  const int lane = lane_of_item();
  if (wanted) {
    const float across = lane < kPatchSide ? (float)(lane - kPatchSide / 2) : 0.0f;
    const int base_x = (int)frame.x - PATCH_REACH, base_y = (int)frame.y - PATCH_REACH;
    const float middle_x = (frame.x - (float)base_x) - across * frame.sine,
                middle_y = (frame.y - (float)base_y) + across * frame.cosine;
    const float low_x = (float)-base_x, high_x = (float)(width - 1 - base_x);
    const float low_y = (float)-base_y, high_y = (float)(height - 1 - base_y);
    const int origin = base_y * width + base_x;
#pragma unroll
    for (int i = 0; i < kPatchRows; ++i) {
      const float along = kPatchRowStep * (float)(i - kPatchRows / 2);
      const float u = clamp(middle_x + along * frame.cosine, low_x, high_x);
      const float v = clamp(middle_y + along * frame.sine, low_y, high_y);
      const int u0 = (int)u, v0 = (int)v;
      const float fx = u - (float)u0, fy = v - (float)v0;
      const int pixel = origin + v0 * width + u0;
      const float a = corner_grey(corners, pixel, 0), b = corner_grey(corners, pixel, 1);
      const float c = corner_grey(corners, pixel, 2), d = corner_grey(corners, pixel, 3);
      const float top = a + fx * (b - a), bottom = c + fx * (d - c);
      column[i] = top + fy * (bottom - top);
    }
  }
  const float middle =
      tell(exchange, wanted ? column[kPatchRows / 2] : 0.0f, 0.0f)[kPatchLanes * patch_in_group() + kPatchSide / 2];
  float sum = 0.0f;
  if (wanted) {
#pragma unroll
    for (int i = 0; i < kPatchRows; ++i) {
      column[i] -= middle;
      sum += column[i];
    }
  }
  const float mean = sum_lanes(exchange, sum) * (1.0f / kPatchSamples);
  if (wanted) {
#pragma unroll
    for (int i = 0; i < kPatchRows; ++i) column[i] -= mean;
  }
}

// Sum of products of two columns.
static inline float column_product(const float* a, const float* b) {
  float sum = 0.0f;
#pragma unroll
  for (int i = 0; i < kPatchRows; ++i) sum += a[i] * b[i];
  return sum;
}

// align_edge(); the samples of `fixed` and `derivative` are GROUP floats apart. Patches that finish early wait for the
// others of the group. Returns ALIGN_LEFT if not `wanted`.
static inline int align_columns(global const uint* corners, const int width, const int height, const PatchFrame moving,
                                const float ex, const float ey, local const float* fixed, const float fixed_norm,
                                local const float* derivative, const float stiffness, const AlignmentSettings settings,
                                const int wanted, Exchange* exchange, float* values, float* move) {
  float alpha = 0.0f;
  int status = wanted ? ALIGN_MOVED : ALIGN_LEFT, going = wanted;
  for (int step = 0; step < settings.steps; ++step) {
    if (!any_patch(tell(exchange, going ? 1.0f : 0.0f, 0.0f))) break;
    PatchFrame moved = moving;
    moved.x += alpha * ex;
    moved.y += alpha * ey;
    cut_column(corners, width, height, moved, going, exchange, values);
    const float norm = sqrt(sum_lanes(exchange, column_product(values, values)));
    const float gain = clamp(fixed_norm / fmax(norm, 1e-3f), 1.0f / kGainMax, kGainMax);
    float curvatures = 0.0f, slopes = 0.0f;
#pragma unroll
    for (int i = 0; i < kPatchRows; ++i) {
      const float residual = fixed[GROUP * i] - gain * values[i];
      const float slope = derivative[GROUP * i];
      const float weighted = settings.huber / max(fabs(residual), settings.huber) * slope;
      curvatures += weighted * slope;
      slopes += weighted * residual;
    }
    const float2 sums = sum_two_lanes(exchange, curvatures, slopes);
    if (!going) continue;
    const float curvature = stiffness + sums.x;
    const float change = curvature < 1e-6f ? 0.0f : (sums.y - stiffness * alpha) / curvature;
    alpha += change;
    if (!(fabs(alpha) <= settings.clamp)) {
      status = ALIGN_LEFT;
      going = 0;
    } else if (fabs(change) < settings.tolerance) {
      status = ALIGN_SETTLED;
      going = 0;
    }
  }
  *move = alpha;
  return status;
}
