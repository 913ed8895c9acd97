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

// For functions of patches: called ones pass the rows through memory.
#define INLINED static inline __attribute__((always_inline))

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

// The same for sixteen directions.
static inline float16 angle_between16(const float16 a, const float b) {
  const float16 d = fabs(a - b);
  return min(d, 2.0f * PI_F - d);
}
static inline float16 line_angle_between16(const float16 a, const float b) {
  const float16 d = angle_between16(a, b);
  return min(d, PI_F - d);
}

// How candidates' directions are compared: with HALF_TURN as in the paper, whose method ignores contrast.
#ifdef HALF_TURN
#define TURN_BETWEEN line_angle_between
#define TURN_BETWEEN16 line_angle_between16
#else
#define TURN_BETWEEN angle_between
#define TURN_BETWEEN16 angle_between16
#endif

// Vectors at any address of their elements. PoCL splits vload16 into pairs of floats and vstore16 into four parts; a
// packed structure becomes one or two plain loads or stores.
typedef struct __attribute__((packed)) {
  float16 lanes;
} packed16;
typedef struct __attribute__((packed)) {
  float8 lanes;
} packed8;
#define LOAD(pointer) (((global const packed16*)(pointer))->lanes)
#define STORE(value, pointer) (((global packed16*)(pointer))->lanes = (value))
#define LOAD8(pointer) (((global const packed8*)(pointer))->lanes)

// Eight values, and sixteen. Two indices, which are not negative, leave a vector register at a time.
static inline uint8 gather8(global const uint* p, const int8 indices) {
  const ulong low = 0xffffffffUL;
  const ulong4 k = as_ulong4(indices);
  return (uint8)(p[k.s0 & low], p[k.s0 >> 32], p[k.s1 & low], p[k.s1 >> 32], p[k.s2 & low], p[k.s2 >> 32],
                 p[k.s3 & low], p[k.s3 >> 32]);
}
static inline uint16 gather16(global const uint* p, const int16 indices) {
  return (uint16)(gather8(p, indices.lo), gather8(p, indices.hi));
}

// Sum of all lanes, and sums of those of either half, always in these orders.
static inline float sum8(const float8 v) {
  const float4 four = v.lo + v.hi;
  const float2 two = four.lo + four.hi;
  return two.x + two.y;
}
static inline float2 sums_of_halves(const float16 v) {
  const float8 four = v.s012389ab + v.s4567cdef;
  const float4 two = four.s0145 + four.s2367;
  return two.even + two.odd;
}

// Lanes of a comparison as bits, lane k at bit k. Compilers see neither that AVX-512 has them as bits
// already nor that AVX gathers them. Of several comparisons the bits are combined: AVX2 would pack their lanes first.
static inline uint lane_bits(const int16 lanes) {
#ifdef __AVX512DQ__
  return (uint)__builtin_ia32_cvtd2mask512(lanes);
#elif defined(__AVX__)
  return (uint)(__builtin_ia32_movmskps256(as_float8(lanes.lo)) | __builtin_ia32_movmskps256(as_float8(lanes.hi)) << 8);
#else
  const int16 bits = lanes & (int16)(1, 1 << 1, 1 << 2, 1 << 3, 1 << 4, 1 << 5, 1 << 6, 1 << 7, 1 << 8, 1 << 9, 1 << 10,
                                     1 << 11, 1 << 12, 1 << 13, 1 << 14, 1 << 15);
  const int8 eight = bits.lo | bits.hi;
  const int4 four = eight.lo | eight.hi;
  const int2 two = four.lo | four.hi;
  return as_uint(two.x | two.y);
#endif
}

// Number of the lowest bit of `bits`, which must not be 0.
static inline int lowest_bit(const uint bits) { return 31 - (int)clz(bits & -bits); }

#ifdef __AVX512F__
// The lanes whose bits are set, in their order from lane 0 on, and any others after them: one instruction and no branch
// in place of a loop over the bits.
#define PACKED_LANES(lanes, bits) as_float16(__builtin_ia32_compresssi512_mask(lanes, lanes, (ushort)(bits)))
#endif
