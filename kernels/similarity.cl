// similarity.cl: how alike two edges are (SPEC section 2). Plain functions for the filters; name this file before theirs.
//
// The layouts are those of patches.cl (112 floats per edge) and sift.cl (256 bytes per edge).
// Reference: patch_similarity() in host/reference/patches.cpp and sift_distance2() in host/reference/sift.cpp, bit by bit.

#define EDGE_FLOATS 112
#define EDGE_BYTES 256

// Sum over eight lanes, halves first.
inline float similarity_sum(const float8 v) {
  const float4 four = v.lo + v.hi;
  const float2 two = four.lo + four.hi;
  return two.x + two.y;
}

// NCC of two edges: the highest of the four products of side patches. Its pairing: 0 dark-dark, 1 bright-bright,
// 2 dark-bright, 3 bright-dark, the first one on a tie.
inline float patch_ncc_pairing(global const float* a, global const float* b, int* pairing) {
  float16 alike = 0.0f, crossed = 0.0f;
  for (int row = 0; row < 7; ++row) {
    const float16 of_a = vload16(row, a), of_b = vload16(row, b);
    alike = fma(of_a, of_b, alike);
    crossed = fma(of_a, of_b.s89abcdef01234567, crossed);
  }
  const float scores[4] = {similarity_sum(alike.lo), similarity_sum(alike.hi), similarity_sum(crossed.lo), similarity_sum(crossed.hi)};
  float best = scores[0];
  int which = 0;
  for (int k = 1; k < 4; ++k) {
    which = scores[k] > best ? k : which;
    best = max(best, scores[k]);
  }
  *pairing = which;
  return best;
}

// Only the NCC.
inline float patch_ncc(global const float* a, global const float* b) {
  int pairing;
  return patch_ncc_pairing(a, b, &pairing);
}

// Sum of squares from its two running forms in 16 bits: `total` modulo 65536 and `high`, the sum of the squares' upper bytes.
// Eight squares a lane: neither `high` nor the sum of the lower bytes, total - 256 high, can overflow.
inline uint4 wide_sum(const ushort16 total, const ushort16 high) {
  const ushort16 low = total - (high << (ushort16)8);
  const uint8 sum = (convert_uint8(high.lo + high.hi) << 8u) + convert_uint8(low.lo + low.hi);
  return sum.lo + sum.hi;
}

// Square of the smallest SIFT distance over the four pairings of sides; exact, at most 128 * 255^2.
inline int sift_distance2(global const uchar* a, global const uchar* b) {
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
    const ushort16 a_dark = convert_ushort16(vload16(k, a)), a_bright = convert_ushort16(vload16(k, a + 128));
    const ushort16 b_dark = convert_ushort16(vload16(k, b)), b_bright = convert_ushort16(vload16(k, b + 128));
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
