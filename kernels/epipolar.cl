// epipolar.cl: the epipolar line of a left pixel (doc/method.md section 3), as EpipolarGeometry of layouts.cl gives it.
// Functions only.
// Needs direction.cl. Reference: host/tracker/geometry/epipolar_geometry.cpp.

// A half line in the right image: from the point of infinite depth towards nearer points.
typedef struct {
  float x, y;    // point of infinite depth, px
  float ex, ey;  // unit direction of growing disparity
  float s_max;   // px from that point to the nearest allowed depth
  int valid;     // 0 where the point at infinity lies behind the right camera
} EpipolarLine;

static inline EpipolarLine epipolar_line(const EpipolarGeometry* g, const float x, const float y) {
  EpipolarLine line;
  const float hx = g->h[0] * x + g->h[1] * y + g->h[2];
  const float hy = g->h[3] * x + g->h[4] * y + g->h[5];
  const float hz = g->h[6] * x + g->h[7] * y + g->h[8];
  const float tx = g->t[0], ty = g->t[1], tz = g->t[2];
  line.x = hx / hz;
  line.y = hy / hz;
  const float dx = tx - line.x * tz;
  const float dy = ty - line.y * tz;
  const float length = sqrt(dx * dx + dy * dy);
  line.valid = hz > 1e-6f && length > 1e-6f;
  line.ex = dx / length;
  line.ey = dy / length;
  const float w = g->inverse_min_depth;
  line.s_max = g->max_disparity;
  if (w > 0.0f) {
    const float nz = hz + w * tz;
    const float nx = (hx + w * tx) / nz - line.x;
    const float ny = (hy + w * ty) / nz - line.y;
    line.s_max = nz > 1e-6f ? sqrt(nx * nx + ny * ny) : 1e5f;
  }
  // The rectification error moves the line and turns it.
  const float px = line.x, py = line.y, ex = line.ex, ey = line.ey;
  const float by_x = g->across[3] * px + g->across[4] * py, by_y = g->across[5] * py;
  const float across = g->across[0] + (g->across[1] + by_x) * px + (g->across[2] + by_y) * py;
  const float turn =
      (g->across[1] + by_x + g->across[3] * px) * ex + (g->across[2] + 2.0f * by_y + g->across[4] * px) * ey;
  line.x += across * ey;
  line.y -= across * ex;
  line.ex += turn * ey;
  line.ey -= turn * ex;
  return line;
}

// Sine of the angle between an edge's tangent and the left epipolar line through it.
static inline float left_epipolar_sine(const EpipolarGeometry* g, const float x, const float y, const float direction) {
  const float dx = g->epipole[0] - g->epipole[2] * x;
  const float dy = g->epipole[1] - g->epipole[2] * y;
  float cosine;
  const float sine = sine_cosine(direction, &cosine);
  return fabs(cosine * dy - sine * dx) / sqrt(dx * dx + dy * dy);
}

// Moves an edge onto the line: along its tangent where the angle between them has at least the sine `min_sine` and the
// shift is shorter than `most` px, else orthogonally. Returns its position s.
static inline float position_on_line(const EpipolarLine* line, const float x, const float y, const float direction,
                                     const float min_sine, const float most) {
  const float dx = x - line->x, dy = y - line->y;
  const float s = dx * line->ex + dy * line->ey;
  const float distance = -dx * line->ey + dy * line->ex;
  float cosine;
  const float sine = sine_cosine(direction, &cosine);
  const float across = -cosine * line->ey + sine * line->ex;  // sine of the angle between line and tangent
  const float along = cosine * line->ex + sine * line->ey;
  if (fabs(across) <= min_sine) return s;
  const float shift = -distance / across;
  return fabs(shift) < most ? s + shift * along : s;
}
