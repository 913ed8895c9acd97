// photometric.cl: photometric alignment of side patches, shared by stereo and temporal refinement. Functions only. Needs direction.cl.
// Reference: host/reference/photometric.cpp.

#define PATCH_SIDE 7
#define PATCH_SAMPLES 49

// Bilinear grey level at (x, y); coordinates outside are clamped to the border.
inline float grey_at(global const uchar* image, const int width, const int height, float x, float y) {
  x = clamp(x, 0.0f, (float)(width - 1));
  y = clamp(y, 0.0f, (float)(height - 1));
  const int x0 = min((int)x, width - 2 < 0 ? 0 : width - 2), y0 = min((int)y, height - 2 < 0 ? 0 : height - 2);
  const int x1 = min(x0 + 1, width - 1), y1 = min(y0 + 1, height - 1);
  const float fx = x - (float)x0, fy = y - (float)y0;
  const float a = image[y0 * width + x0], b = image[y0 * width + x1];
  const float c = image[y1 * width + x0], d = image[y1 * width + x1];
  const float top = a + fx * (b - a), bottom = c + fx * (d - c);
  return top + fy * (bottom - top);
}

// Where a side patch lies: its first sample and the steps along the tangent (i) and along the normal to the dark side (j).
typedef struct {
  float x, y;
  float cosine, sine;
} PatchFrame;

// `side`: +1 bright, -1 dark.
inline PatchFrame patch_frame(const float x, const float y, const float cosine, const float sine, const float side,
                              const float offset) {
  PatchFrame frame;
  frame.cosine = cosine;
  frame.sine = sine;
  frame.x = x + side * offset * sine - 3.0f * cosine + 3.0f * sine;
  frame.y = y - side * offset * cosine - 3.0f * sine - 3.0f * cosine;
  return frame;
}

inline PatchFrame directed_frame(const float x, const float y, const float direction, const float side, const float offset) {
  float cosine;
  const float sine = sine_cosine(direction, &cosine);
  return patch_frame(x, y, cosine, sine, side, offset);
}

// Mean-free grey levels of a patch moved by (dx, dy).
inline void cut_patch(global const uchar* image, const int width, const int height, const PatchFrame frame, const float dx,
                      const float dy, float* values) {
  float sum = 0.0f;
  for (int i = 0; i < PATCH_SIDE; ++i) {
    for (int j = 0; j < PATCH_SIDE; ++j) {
      const float x = frame.x + dx + (float)i * frame.cosine - (float)j * frame.sine;
      const float y = frame.y + dy + (float)i * frame.sine + (float)j * frame.cosine;
      const float value = grey_at(image, width, height, x, y);
      values[PATCH_SIDE * i + j] = value;
      sum += value;
    }
  }
  const float mean = sum / (float)PATCH_SAMPLES;
  for (int k = 0; k < PATCH_SAMPLES; ++k) values[k] -= mean;
}

// Mean-free derivative of a patch along the unit vector (ex, ey), grey levels per px: central difference over 1 px.
inline void patch_derivative(global const uchar* image, const int width, const int height, const PatchFrame frame,
                             const float ex, const float ey, float* values) {
  float ahead[PATCH_SAMPLES];
  cut_patch(image, width, height, frame, 0.5f * ex, 0.5f * ey, ahead);
  cut_patch(image, width, height, frame, -0.5f * ex, -0.5f * ey, values);
  for (int k = 0; k < PATCH_SAMPLES; ++k) values[k] = ahead[k] - values[k];
}

// Settings of the Gauss-Newton loops.
typedef struct {
  int steps;
  float tolerance;  // px
  float huber;      // grey levels
  float clamp;      // px
  float rms_max;    // grey levels
} RefinementSettings;

inline float huber_weight(const float residual, const float limit) {
  const float magnitude = fabs(residual);
  return magnitude <= limit ? 1.0f : limit / magnitude;
}

// Gauss-Newton on the move `alpha` along (ex, ey) that makes the patch at `moving` look like `fixed`; `derivative` is the
// derivative of `fixed` along the move. Returns 0 when it diverged or the residual stayed large.
inline int align_along_line(global const uchar* image, const int width, const int height, const PatchFrame moving,
                            const float ex, const float ey, const float* fixed, const float* derivative,
                            const RefinementSettings settings, float* alpha) {
  float values[PATCH_SAMPLES];
  float move = 0.0f, rms = 0.0f;
  for (int step = 0; step < settings.steps; ++step) {
    cut_patch(image, width, height, moving, move * ex, move * ey, values);
    float curvature = 0.0f, slope = 0.0f, squares = 0.0f;
    for (int k = 0; k < PATCH_SAMPLES; ++k) {
      const float residual = fixed[k] - values[k];
      const float weight = huber_weight(residual, settings.huber);
      curvature += weight * derivative[k] * derivative[k];
      slope += weight * derivative[k] * residual;
      squares += residual * residual;
    }
    rms = sqrt(squares / (float)PATCH_SAMPLES);
    if (curvature < 1e-6f) break;
    const float change = slope / curvature;
    move += change;
    if (!(fabs(move) <= settings.clamp)) return 0;
    if (fabs(change) < settings.tolerance) break;
  }
  *alpha = move;
  return rms <= settings.rms_max;
}
