// common.cl: shared by all kernels, prepended to every program.
//
// Host and device must round in the same way: a*b+c is never fused.
#pragma OPENCL FP_CONTRACT OFF

// MAX_VALUE: largest value of the recorded images' pixels, 0 to 255 grey levels whatever their depth.
#ifndef MAX_VALUE
#define MAX_VALUE 255
#endif
#if MAX_VALUE > 255
typedef ushort Pixel;
#else
typedef uchar Pixel;
#endif
#define GREY_PER_VALUE (255.0f / (float)MAX_VALUE)

// For kernels written with vector types. Without the hint Intel's compiler for CPUs also vectorises across work-items:
// compilation takes two to four times as long, a minute for temporal_match.cl. Other compilers ignore it.
#define IN_VECTORS __attribute__((vec_type_hint(float16)))

#ifndef PI_F
#define PI_F 3.14159265358979f
#endif

// Smallest difference of two directions modulo a full turn, radians in [0, pi].
static inline float angle_between(float a, float b) {
  float d = fabs(a - b);
  return d > PI_F ? 2.0f * PI_F - d : d;
}

// Smallest difference of two directions modulo half a turn, radians in [0, pi/2].
static inline float line_angle_between(float a, float b) {
  const float d = angle_between(a, b);
  return d > 0.5f * PI_F ? PI_F - d : d;
}
