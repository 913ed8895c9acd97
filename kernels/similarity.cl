// similarity.cl: similarity of two edges (doc/method.md section 2). Functions only; needs described_edges.cl. List this
// file before the filters that use it.
//
// The layouts are those of patches.cl and sift.cl.
// Reference, bit by bit: patch_ncc() and sift_distance2() in host/workbench/reference/edge_descriptions.cpp.

// The four products of side patches: dark-dark, bright-bright, dark-bright, bright-dark.
static inline float4 patch_scores(global const char* a, global const char* b) {
  // A product of two samples fits 16 bits, and so does the sum of two, at most 2 * 127^2.
  short16 of_a[kPatchRows], of_b[kPatchRows];
#pragma unroll
  for (int row = 0; row < kPatchRows; ++row) {
    of_a[row] = convert_short16(patch_row(a, row));
    of_b[row] = convert_short16(patch_row(b, row));
  }
  const int last = kPatchRows - 1;  // an even number of rows before it
  int16 alike = convert_int16(of_a[last] * of_b[last]),
        crossed = convert_int16(of_a[last] * of_b[last].s89abcdef01234567);
#pragma unroll
  for (int row = 0; row < last; row += 2) {
    alike += convert_int16(of_a[row] * of_b[row] + of_a[row + 1] * of_b[row + 1]);
    crossed += convert_int16(of_a[row] * of_b[row].s89abcdef01234567 + of_a[row + 1] * of_b[row + 1].s89abcdef01234567);
  }
  const int8 same_sides = (int8)(alike.s0123 + alike.s4567, alike.s89ab + alike.scdef);
  const int8 other_sides = (int8)(crossed.s0123 + crossed.s4567, crossed.s89ab + crossed.scdef);
  const int8 twos = (int8)(same_sides.even + same_sides.odd, other_sides.even + other_sides.odd);
  const float2 inverse_a = patch_norms(a), inverse_b = patch_norms(b);
  return convert_float4(twos.even + twos.odd) * inverse_a.xyxy * inverse_b.xyyx;
}

// NCC of two edges: the highest of the four products of side patches.
static inline float patch_ncc(global const char* a, global const char* b) {
  const float4 scores = patch_scores(a, b);
  return max(max(scores.x, scores.y), max(scores.z, scores.w));
}

// Sum of squares from its two running forms in 16 bits: `total` modulo 65536 and `high`, the sum of the squares' upper
// bytes.
// Eight squares a lane: neither `high` nor the sum of the lower bytes, total - 256 high, can overflow.
static inline uint4 wide_sum(const ushort16 total, const ushort16 high) {
  const ushort16 low = total - (high << (ushort16)8);
  const uint8 sum = (convert_uint8(high.lo + high.hi) << 8u) + convert_uint8(low.lo + low.hi);
  return sum.lo + sum.hi;
}

// Square of the smallest SIFT distance over the four pairings of sides; exact, at most 128 * 255^2.
static inline int sift_distance2(global const uchar* a, global const uchar* b) {
  // A difference of bytes fits 16 bits modulo 65536, and so does its square, at most 65025.
  ushort16 total_dd = 0, total_bb = 0, total_db = 0, total_bd = 0, high_dd = 0, high_bb = 0, high_db = 0, high_bd = 0;
#define ADD_SQUARES(total, high, p, q)               \
  {                                                  \
    const ushort16 difference = (p) - (q);           \
    const ushort16 square = difference * difference; \
    total += square;                                 \
    high += square >> (ushort16)8;                   \
  }
  for (int k = 0; k < 8; ++k) {
    const ushort16 a_dark = convert_ushort16(descriptor_part(a, k)),
                   a_bright = convert_ushort16(descriptor_part(a, k + 8));
    const ushort16 b_dark = convert_ushort16(descriptor_part(b, k)),
                   b_bright = convert_ushort16(descriptor_part(b, k + 8));
    ADD_SQUARES(total_dd, high_dd, a_dark, b_dark)
    ADD_SQUARES(total_bb, high_bb, a_bright, b_bright)
    ADD_SQUARES(total_db, high_db, a_dark, b_bright)
    ADD_SQUARES(total_bd, high_bd, a_bright, b_dark)
  }
#undef ADD_SQUARES
  const uint4 one = wide_sum(total_dd, high_dd), two = wide_sum(total_bb, high_bb);
  const uint4 three = wide_sum(total_db, high_db), four = wide_sum(total_bd, high_bd);
  const uint4 sums = ((uint4)(one.x, two.x, three.x, four.x) + (uint4)(one.y, two.y, three.y, four.y)) +
                     ((uint4)(one.z, two.z, three.z, four.z) + (uint4)(one.w, two.w, three.w, four.w));
  return (int)min(min(sums.x, sums.y), min(sums.z, sums.w));
}
