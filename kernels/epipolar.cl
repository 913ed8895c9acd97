// epipolar.cl: the epipolar line of a left pixel (host/common/epipolar_geometry.hpp, doc/method.md section 3). Functions only. Needs direction.cl.

// Offsets into the packed EpipolarGeometry.
#define GEOMETRY_T 9
#define GEOMETRY_EPIPOLE 12
#define GEOMETRY_INVERSE_MIN_DEPTH 15
#define GEOMETRY_MAX_DISPARITY 16
#define GEOMETRY_TOLERANCE 17
#define GEOMETRY_EPIPOLAR_DISTANCE 18
#define GEOMETRY_ORIENTATION 19
#define GEOMETRY_MIN_EPIPOLAR_SINE 20

// A half line in the right image: from the point of infinite depth towards nearer points.
typedef struct {
  float x, y;    // point of infinite depth, px
  float ex, ey;  // unit direction of growing disparity
  float s_max;   // px from that point to the nearest allowed depth
  int valid;     // 0 where the point at infinity lies behind the right camera
} EpipolarLine;

inline EpipolarLine epipolar_line(global const float* g, const float x, const float y) {
  EpipolarLine line;
  const float hx = g[0] * x + g[1] * y + g[2];
  const float hy = g[3] * x + g[4] * y + g[5];
  const float hz = g[6] * x + g[7] * y + g[8];
  const float tx = g[GEOMETRY_T], ty = g[GEOMETRY_T + 1], tz = g[GEOMETRY_T + 2];
  line.x = hx / hz;
  line.y = hy / hz;
  const float dx = tx - line.x * tz;
  const float dy = ty - line.y * tz;
  const float length = sqrt(dx * dx + dy * dy);
  line.valid = hz > 1e-6f && length > 1e-6f;
  line.ex = dx / length;
  line.ey = dy / length;
  const float w = g[GEOMETRY_INVERSE_MIN_DEPTH];
  line.s_max = g[GEOMETRY_MAX_DISPARITY];
  if (w > 0.0f) {
    const float nz = hz + w * tz;
    const float nx = (hx + w * tx) / nz - line.x;
    const float ny = (hy + w * ty) / nz - line.y;
    line.s_max = nz > 1e-6f ? sqrt(nx * nx + ny * ny) : 1e5f;
  }
  return line;
}

// Sine of the angle between an edge's tangent and the left epipolar line through it.
inline float left_epipolar_sine(global const float* g, const float x, const float y, const float direction) {
  const float dx = g[GEOMETRY_EPIPOLE] - g[GEOMETRY_EPIPOLE + 2] * x;
  const float dy = g[GEOMETRY_EPIPOLE + 1] - g[GEOMETRY_EPIPOLE + 2] * y;
  float cosine;
  const float sine = sine_cosine(direction, &cosine);
  return fabs(cosine * dy - sine * dx) / sqrt(dx * dx + dy * dy);
}
