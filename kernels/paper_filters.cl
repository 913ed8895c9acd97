// paper_filters.cl: NCC of all candidates by the paper's side patches; candidate_filters.cl then decides.
//
// In: candidate lists; patches of both sets of edges (laid out as kPaperPatchFloats of layouts.cl says), with the patch
// number of every edge.
// Out: ncc, the highest of the four pairings of sides, -1 where patches are flat. One work-item = one row; four
// candidates at once, each of which is summed in the same order.
// Reference: judge() in host/workbench/paper/cascades.cpp.

// Sums of both halves of two vectors, of four lanes and then of two: groups of lanes in the order of the vectors.
static inline float16 fours(const float16 a, const float16 b) {
  return (float16)(a.s0123, a.s89ab, b.s0123, b.s89ab) + (float16)(a.s4567, a.scdef, b.s4567, b.scdef);
}
static inline float16 twos(const float16 a, const float16 b) {
  return (float16)(a.s014589cd, b.s014589cd) + (float16)(a.s2367abef, b.s2367abef);
}

kernel IN_VECTORS void paper_ncc(const FilterArguments args, global const int* first, global const int* target,
                                 global const float* patches_a, global const int* patch_of_a,
                                 global const float* patches_b, global const int* patch_of_b, global float* ncc) {
  const int row = (int)get_global_id(0);
  if (row >= args.rows) return;
  const int begin = first[row], end = min(first[row + 1], args.capacity);
  if (begin >= end) return;
  global const float* own = patches_a + kPaperPatchFloats * (size_t)patch_of_a[row * args.row_step];
  float16 rows[kPaperPatchRows], turned[kPaperPatchRows];  // the latter with dark and bright exchanged
#pragma unroll
  for (int i = 0; i < kPaperPatchRows; ++i) {
    rows[i] = ((global const float16*)own)[i];
    turned[i] = rows[i].s89abcdef01234567;
  }
  const float4 inverse = (*(global const float2*)(own + kPaperInverseNorms)).xyyx;
  for (int c = begin; c < end; c += 4) {
    float16 alike[4], crossed[4];
    float2 others[4];
#pragma unroll
    for (int k = 0; k < 4; ++k) {
      global const float* other = patches_b + kPaperPatchFloats * (size_t)patch_of_b[target[min(c + k, end - 1)]];
      alike[k] = crossed[k] = 0.0f;
#pragma unroll
      for (int i = 0; i < kPaperPatchRows; ++i) {
        const float16 of_other = ((global const float16*)other)[i];
        alike[k] = fma(rows[i], of_other, alike[k]);
        crossed[k] = fma(turned[i], of_other, crossed[k]);
      }
      others[k] = *(global const float2*)(other + kPaperInverseNorms);
    }
    // Per candidate: dark with dark, bright with bright, bright with dark, dark with bright.
    const float16 a = twos(fours(alike[0], crossed[0]), fours(alike[1], crossed[1]));
    const float16 b = twos(fours(alike[2], crossed[2]), fours(alike[3], crossed[3]));
    const float16 products = (float16)(a.even, b.even) + (float16)(a.odd, b.odd);
    const float16 norms = (float16)(inverse, inverse, inverse, inverse) *
                          (float16)(others[0].xyxy, others[1].xyxy, others[2].xyxy, others[3].xyxy);
    const float16 scores = select((float16)-1.0f, products * norms, norms > 0.0f);
    const float8 pairs = max(scores.even, scores.odd);
    const float4 best = max(max(pairs.even, pairs.odd), (float4)-1.0f);
    if (c + 4 <= end) {
      vstore4(best, 0, ncc + c);
    } else {
      ncc[c] = best.x;
      if (c + 1 < end) ncc[c + 1] = best.y;
      if (c + 2 < end) ncc[c + 2] = best.z;
    }
  }
}
