// patches.cl: two side patches of 7 x 5 samples per edge, mean-free, in 8 bits with their norms (doc/method.md section
// 2).
//
// In: corners of the image (pixel_corners.cl), edges (x, y [px], direction [rad]), which of them are wanted (not 0).
// Out: kEdgePatchBytes per edge, laid out as in host/workbench/reference/edge_descriptions.hpp; those of the other
// edges are left as they were. Two forms with the same arithmetic in the same order:
//   without GROUP: one work-item = one edge, the samples across the edge of both sides are the lanes of a float16;
//   with GROUP: kPatchItems work-items per edge, eight per side, one per lane; groups of GROUP work-items, local memory
//   EXCHANGE_FLOATS floats.
// Needs direction.cl and photometric.cl, with GROUP photometric_lanes.cl too.
// Reference: host/workbench/reference/edge_descriptions.cpp.

// Adding and subtracting it rounds to the nearest integer, halves to even, because floats of about 1.5 * 2^23 have no
// fraction bits.
#define NO_FRACTION 12582912.0f

#ifdef GROUP
#define SIDES float  // a value of the work-item's side
#else
#define SIDES float2  // of both sides
#endif

// Patches are stored as integers of magnitude up to kPatchLargest, flat ones as zeros. Sums of their squares are below
// 2^24, which floats represent exactly.
static inline SIDES scale_of(const SIDES largest) {
  return largest < kFlatPatchContrast ? (SIDES)(0.0f) : (float)kPatchLargest / largest;
}
static inline SIDES inverse_norm(const SIDES squares) { return squares == 0.0f ? (SIDES)(0.0f) : 1.0f / sqrt(squares); }

#ifndef GROUP

static inline float16 both_used(const float16 v) { return (float16)(used_lanes(v.lo), used_lanes(v.hi)); }

// The largest lane of either side; no value is negative.
static inline float2 largest_lanes(const float16 v) {
  const float8 four = max(v.s012389ab, v.s4567cdef);
  const float4 two = max(four.s0145, four.s2367);
  return max(two.even, two.odd);
}

kernel void side_patches(const PatchArguments args, global const uint* corners, global const float* positions,
                         global const int* wanted, global char* patches) {
  const int width = args.width, height = args.height, count = args.edges.count;
  const float offset = args.offset;
  global const float* xs = positions + args.edges.first;
  global const float* ys = xs + args.edges.stride;
  global const float* directions = ys + args.edges.stride;
  const int edge = (int)get_global_id(0);
  if (edge >= count || !(args.all || wanted[edge] != 0)) return;
  float cosine;
  const float sine = sine_cosine(directions[edge], &cosine);
  global char* patch = patches + (size_t)edge * kEdgePatchBytes;
  const float x = xs[edge], y = ys[edge];
  float16 rows[kPatchRows];
  cut_two_patches(corners, width, height, patch_frame(x, y, cosine, sine, 1.0f, offset),
                  patch_frame(x, y, cosine, sine, -1.0f, offset), rows);
  float16 largest = 0.0f, squares = 0.0f;
#pragma unroll
  for (int i = 0; i < kPatchRows; ++i) largest = max(largest, fabs(rows[i]));
  const float2 scales = scale_of(largest_lanes(both_used(largest)));
  const float16 scale = (float16)((float8)(scales.x), (float8)(scales.y));
#pragma unroll
  for (int i = 0; i < kPatchRows; ++i) {
    const float16 row = both_used((rows[i] * scale + NO_FRACTION) - NO_FRACTION);
    squares += row * row;
    ((global char16*)patch)[i] = convert_char16(row);
  }
  *(global float4*)(patch + kInverseNorms) = (float4)(inverse_norm(sums_of_halves(squares)), 0.0f, 0.0f);
}

#else

// The largest of the seven used lanes.
static inline float largest_used(const float8 v) {
  const float8 used = used_lanes(v);
  const float4 four = max(used.lo, used.hi);
  const float2 two = max(four.lo, four.hi);
  return max(two.x, two.y);
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void side_patches(const PatchArguments args,
                                                                            global const uint* corners,
                                                                            global const float* positions,
                                                                            global const int* wanted,
                                                                            global char* patches) {
  local float memory[EXCHANGE_FLOATS];
  const int width = args.width, height = args.height, count = args.edges.count;
  const float offset = args.offset;
  global const float* xs = positions + args.edges.first;
  global const float* ys = xs + args.edges.stride;
  global const float* directions = ys + args.edges.stride;
  Exchange exchange = {memory, 0};
  const int lane = lane_of_item(), side = patch_in_group() & 1;
  const int own = (int)(get_global_id(0) / kPatchItems);
  const int edge = min(own, count - 1);  // surplus work-items repeat the last edge, since all must reach the barriers
  int any = args.all;                    // edge of the group is wanted
  const int first = (int)get_group_id(0) * (GROUP / kPatchItems);
  for (int k = first; k < min(first + GROUP / kPatchItems, count) && any == 0; ++k) any = wanted[k];
  if (any == 0) return;
  float cosine;
  const float sine = sine_cosine(directions[edge], &cosine);
  float rows[kPatchRows];
  cut_column(corners, width, height, patch_frame(xs[edge], ys[edge], cosine, sine, side == 0 ? 1.0f : -1.0f, offset), 1,
             &exchange, rows);
  float largest = 0.0f, squares = 0.0f;
  for (int i = 0; i < kPatchRows; ++i) largest = max(largest, fabs(rows[i]));
  const float scale = scale_of(largest_used(patch_lanes(&exchange, largest)));
  for (int i = 0; i < kPatchRows; ++i) {
    rows[i] = (rows[i] * scale + NO_FRACTION) - NO_FRACTION;
    squares += rows[i] * rows[i];
  }
  const float inverse = inverse_norm(sum_lanes(&exchange, squares));
  if (own >= count || !(args.all || wanted[own] != 0)) return;
  global char* patch = patches + (size_t)edge * kEdgePatchBytes;
  for (int i = 0; i < kPatchRows; ++i) patch[16 * i + 8 * side + lane] = lane < kPatchSide ? (char)rows[i] : (char)0;
  if (lane < 2) ((global float*)(patch + kInverseNorms))[2 * lane + side] = lane == 0 ? inverse : 0.0f;
}

#endif
