// similarity_lanes.cl: similarity of side patches (similarity.cl) with eight work-items per pair of edges, each with a
// row of their bytes.
// Functions only; needs described_edges.cl. All sums are integers, so their order does not matter.

#define PAIR_ITEMS 8  // one per row of 16 bytes of the patches; some idle

// The products of a row of side patches, 16 bytes each: dark-dark, bright-bright, dark-bright, bright-dark.
static inline int4 row_products(const char16 of_a, const char16 of_b) {
  const short16 a = convert_short16(of_a), b = convert_short16(of_b);
  const int16 alike = convert_int16(a * b), crossed = convert_int16(a * b.s89abcdef01234567);
  const int8 same = (int8)(alike.s0123 + alike.s4567, alike.s89ab + alike.scdef);
  const int8 other = (int8)(crossed.s0123 + crossed.s4567, crossed.s89ab + crossed.scdef);
  const int8 twos = (int8)(same.even + same.odd, other.even + other.odd);
  return twos.even + twos.odd;
}

static inline int4 sum_of_items(local const int4* parts, const int count) {
  int4 sum = parts[0];
  for (int k = 1; k < count; ++k) sum += parts[k];
  return sum;
}
