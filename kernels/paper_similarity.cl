// paper_similarity.cl: NCC of the paper's side patches, in the layout of paper_patches.cl. Functions only; list this
// file after similarity.cl and before candidate_filters.cl, which then reads these patches.
// Reference: best_pairing() in host/paper/side_patches.cpp.

#define PATCH_VALUE float
#define PATCH_VALUES kPaperPatchFloats
#define OPENED_PATCH PaperPatch
#define OPEN_PATCH open_paper_patch
#define PATCH_NCC paper_patch_ncc
#define DESCRIPTOR_OF(patch_of, edge) ((patch_of)[edge])

// Patches of an edge that is compared with many: its rows, and the same with dark and bright exchanged.
typedef struct {
  float16 rows[kPaperPatchRows], turned[kPaperPatchRows];
  float4 inverse;  // norms, of dark, bright, dark, bright
} PaperPatch;

static inline PaperPatch open_paper_patch(global const float* patch) {
  PaperPatch opened;
#pragma unroll
  for (int row = 0; row < kPaperPatchRows; ++row) {
    opened.rows[row] = ((global const float16*)patch)[row];
    opened.turned[row] = opened.rows[row].s89abcdef01234567;
  }
  opened.inverse = vload2(0, patch + kPaperInverseNorms).xyxy;
  return opened;
}

// The highest NCC of the four pairings of sides; -1 where patches are flat.
static inline float paper_patch_ncc(const PaperPatch a, global const float* b) {
  float16 alike = 0.0f, crossed = 0.0f;
#pragma unroll
  for (int row = 0; row < kPaperPatchRows; ++row) {
    const float16 of_b = ((global const float16*)b)[row];
    alike = fma(a.rows[row], of_b, alike);
    crossed = fma(a.turned[row], of_b, crossed);
  }
  // Sums of the lanes: dark with dark, bright with bright; bright with dark, dark with bright.
  const float8 same_sides = (float8)(alike.s0123 + alike.s4567, alike.s89ab + alike.scdef);
  const float8 other_sides = (float8)(crossed.s89ab + crossed.scdef, crossed.s0123 + crossed.s4567);
  const float8 twos = (float8)(same_sides.even + same_sides.odd, other_sides.even + other_sides.odd);
  const float4 norms = a.inverse * vload2(0, b + kPaperInverseNorms).xyyx;
  const float4 scores = select((float4)-1.0f, (twos.even + twos.odd) * norms, norms > 0.0f);
  return max(max(max(scores.x, scores.y), max(scores.z, scores.w)), -1.0f);
}
