// paper_sides.cl: samples beside an edge in the paper's method, and similarity of side patches. Functions only.
// Needs direction.cl.
//
// A picture has a record per pixel, and one more per row: its own word, and that of the pixel below, border replicated.
// A word holds the grey value and both slopes as integers, 8 Sobel units per grey value and px; images of more than 8
// bits have two of them. Rows of samples are float16 as in layouts.cl: dark side in the low, bright side in the high
// half; lanes 7 and 15 repeat a sample. Structures are returned through pointers: oclgrind cannot run always-inlined
// functions that return them in a loop.
// Reference: host/workbench/paper/side_patches.cpp.

#define BOTH_SIDES(dark, bright) (float16)((float8)(dark), (float8)(bright))
#define HALVES_SWAPPED(v) (v).s89abcdef01234567

typedef struct {
  global const uint* records;
  int width, height;  // px
} Picture;

#if MAX_VALUE > 255
// 12 bits of the grey value beside the slope along x, the others beside that along y.
#define PIXEL_WORDS 2
#define GREY_OF(w, v) convert_float16(as_int16(((w)&4095u) | ((v)&4095u) << 12u))
#define SLOPE_X_OF(w, v) convert_float16(as_int16(w) >> 12)
#define SLOPE_Y_OF(w, v) convert_float16(as_int16(v) >> 12)
#else
#define PIXEL_WORDS 1
#define GREY_OF(w, v) convert_float16(as_int16((w)&255u))
#define SLOPE_X_OF(w, v) convert_float16(as_int16((w) << 12u) >> 20)
#define SLOPE_Y_OF(w, v) convert_float16(as_int16(w) >> 20)
#endif
#define PER_SLOPE_UNIT (0.125f * GREY_PER_VALUE)

// Sixteen samples' words of the four corners.
typedef struct {
  uint16 a, b, c, d;
} Corners;

// Sixteen bytes: in images of 8 bits two records, else one.
typedef struct __attribute__((packed, aligned(8))) {
  ulong2 words;
} Records;
// Pairs of words travel as ulong: compilers take words that are moved one by one apart into sixteen insertions.
#define RECORD_AT(k) (((global const Records*)((global const uchar*)records + (k)))->words)
#define FOUR_RECORDS(i, j, k, l) \
  as_uint16((ulong8)(RECORD_AT(bytes.s##i), RECORD_AT(bytes.s##j), RECORD_AT(bytes.s##k), RECORD_AT(bytes.s##l)))
#define LOW_WORDS(p, q) \
  as_ulong8((uint16)(p.s0, q.s0, p.s1, q.s1, p.s4, q.s4, p.s5, q.s5, p.s8, q.s8, p.s9, q.s9, p.sc, q.sc, p.sd, q.sd))
#define HIGH_WORDS(p, q) \
  as_ulong8((uint16)(p.s2, q.s2, p.s3, q.s3, p.s6, q.s6, p.s7, q.s7, p.sa, q.sa, p.sb, q.sb, p.se, q.se, p.sf, q.sf))
#define EVEN_PAIRS(p, q) as_uint16((ulong8)(p.s0, q.s0, p.s2, q.s2, p.s4, q.s4, p.s6, q.s6))
#define ODD_PAIRS(p, q) as_uint16((ulong8)(p.s1, q.s1, p.s3, q.s3, p.s5, q.s5, p.s7, q.s7))

// The four words of sixteen samples' records, first to last.
typedef struct {
  uint16 s0, s1, s2, s3;
} FourWords;

// Byte offsets of sixteen samples.
typedef struct {
  uint s0, s1, s2, s3, s4, s5, s6, s7, s8, s9, sa, sb, sc, sd, se, sf;
} Offsets;

INLINED void words_at(global const uint* records, const Offsets bytes, FourWords* words) {
  const uint16 p = FOUR_RECORDS(0, 4, 8, c), q = FOUR_RECORDS(1, 5, 9, d);
  const uint16 r = FOUR_RECORDS(2, 6, a, e), s = FOUR_RECORDS(3, 7, b, f);
  const ulong8 low_pq = LOW_WORDS(p, q), low_rs = LOW_WORDS(r, s);
  const ulong8 high_pq = HIGH_WORDS(p, q), high_rs = HIGH_WORDS(r, s);
  words->s0 = EVEN_PAIRS(low_pq, low_rs);
  words->s1 = ODD_PAIRS(low_pq, low_rs);
  words->s2 = EVEN_PAIRS(high_pq, high_rs);
  words->s3 = ODD_PAIRS(high_pq, high_rs);
}

// Where the samples of both patches of an edge lie, relative to a pixel up and left of all of them: those abreast of
// the edge, and the step to the next row.
typedef struct {
  float16 x, y;
  float cosine, sine;
  float low_x, high_x, low_y, high_y;  // the picture's border
  int origin;                          // number of that pixel
  int inside;                          // no sample can be outside the picture
} Samples;

INLINED void samples_beside(const Picture picture, const float edge_x, const float edge_y, const float cosine,
                            const float sine, const float offset, Samples* samples) {
  const float16 across =
      (float16)(-3.0f, -2.0f, -1.0f, 0.0f, 1.0f, 2.0f, 3.0f, 0.0f, -3.0f, -2.0f, -1.0f, 0.0f, 1.0f, 2.0f, 3.0f, 0.0f) +
      BOTH_SIDES(-offset, offset);
  const int reach = (int)offset + 5;  // px, more than the distance of the farthest sample
  // Beyond this nothing changes any more.
  const float x = clamp(edge_x, (float)(-reach - 1), (float)(picture.width + reach));
  const float y = clamp(edge_y, (float)(-reach - 1), (float)(picture.height + reach));
  const int base_x = (int)x - reach, base_y = (int)y - reach;
  Samples at;
  at.x = (x - (float)base_x) - across * sine;
  at.y = (y - (float)base_y) + across * cosine;
  at.cosine = cosine;
  at.sine = sine;
  at.low_x = (float)-base_x;
  at.low_y = (float)-base_y;
  at.high_x = (float)(picture.width - 1 - base_x);
  at.high_y = (float)(picture.height - 1 - base_y);
  at.origin = base_y * (picture.width + 1) + base_x;
  at.inside = base_x >= 0 && base_y >= 0 && base_x + 2 * reach < picture.width && base_y + 2 * reach < picture.height;
  *samples = at;
}

// x86-64 takes vectors apart faster through memory than lane by lane, which compilers would choose.
#ifdef __x86_64__
#define STORED volatile
#else
#define STORED
#endif

// Where the rows' samples lie: the byte offsets of their records, and the place to the right of and below these.
typedef struct {
  STORED uint16 bytes[kPaperPatchRows];
  float16 u[kPaperPatchRows], v[kPaperPatchRows];
} Places;

// \param clamped whether samples may be outside the picture
INLINED void place_rows(const Picture picture, const Samples* at, const int clamped, Places* places) {
#pragma unroll
  for (int i = 0; i < kPaperPatchRows; ++i) {
    const float along = (float)(i - kPaperPatchRows / 2);
    float16 x = at->x + along * at->cosine, y = at->y + along * at->sine;
    if (clamped) {
      x = clamp(x, at->low_x, at->high_x);
      y = clamp(y, at->low_y, at->high_y);
    }
    const int16 x0 = convert_int16(x), y0 = convert_int16(y);
    places->bytes[i] = as_uint16((y0 * (picture.width + 1) + x0 + at->origin) * (8 * PIXEL_WORDS));
    places->u[i] = x - convert_float16(x0);
    places->v[i] = y - convert_float16(y0);
  }
}

// One row of samples: the words around them and where they lie between these.
typedef struct {
  Corners words, more;
  float16 u, v;
} RowSamples;

INLINED void read_row(const Picture picture, const Places* places, const int row, RowSamples* samples) {
  STORED const uint* at = (STORED const uint*)&places->bytes[row];
  const Offsets bytes = {at[0], at[1], at[2],  at[3],  at[4],  at[5],  at[6],  at[7],
                         at[8], at[9], at[10], at[11], at[12], at[13], at[14], at[15]};
  FourWords here;
  words_at(picture.records, bytes, &here);
#if MAX_VALUE > 255
  FourWords right;
  words_at(picture.records + 4, bytes, &right);
  const Corners words = {here.s0, right.s0, here.s2, right.s2}, more = {here.s1, right.s1, here.s3, right.s3};
#else
  const Corners words = {here.s0, here.s2, here.s1, here.s3}, more = words;
#endif
  samples->words = words;
  samples->more = more;
  samples->u = places->u[row];
  samples->v = places->v[row];
}

INLINED float16 between(const RowSamples* row, const float16 a, const float16 b, const float16 c, const float16 d) {
  const float16 top = a + row->u * (b - a), bottom = c + row->u * (d - c);
  return top + row->v * (bottom - top);
}
#define INTERPOLATED(OF, row)                                                        \
  between(row, OF((row)->words.a, (row)->more.a), OF((row)->words.b, (row)->more.b), \
          OF((row)->words.c, (row)->more.c), OF((row)->words.d, (row)->more.d))
INLINED float16 grey_of(const RowSamples* row) { return INTERPOLATED(GREY_OF, row) * GREY_PER_VALUE; }

// The lanes of a row that are samples; the others become zero.
static inline float16 used_lanes(const float16 v) {
  return as_float16(as_int16(v) & (int16)(-1, -1, -1, -1, -1, -1, -1, 0, -1, -1, -1, -1, -1, -1, -1, 0));
}

// Means of the dark and of the bright samples, in the lanes of each.
INLINED float16 means_of_sides(const float16 sum) {
  const float2 means = sums_of_halves(used_lanes(sum)) * (1.0f / (kPaperPatchRows * kPaperPatchRows));
  return BOTH_SIDES(means.x, means.y);
}

// Both patches of an edge: mean-free rows. Subtracting a sample first makes those of a flat picture exactly zero.
INLINED void cut_sides(const Picture picture, const float x, const float y, const float cosine, const float sine,
                       const float offset, float16* rows) {
  Samples at;
  samples_beside(picture, x, y, cosine, sine, offset, &at);
  Places places;
  place_rows(picture, &at, !at.inside, &places);
  for (int i = 0; i < kPaperPatchRows; ++i) {
    RowSamples row;
    read_row(picture, &places, i, &row);
    rows[i] = grey_of(&row);
  }
  const float16 middle = BOTH_SIDES(rows[kPaperPatchRows / 2].s3, rows[kPaperPatchRows / 2].sb);
  float16 sum = 0.0f;
#pragma unroll
  for (int i = 0; i < kPaperPatchRows; ++i) {
    rows[i] -= middle;
    sum += rows[i];
  }
  const float16 means = means_of_sides(sum);
#pragma unroll
  for (int i = 0; i < kPaperPatchRows; ++i) rows[i] = used_lanes(rows[i] - means);
}

// 1 / norm of both patches; 0 where one is flat.
static inline float2 inverse_norms(const float16* rows) {
  float16 products = 0.0f;
  for (int i = 0; i < kPaperPatchRows; ++i) products += rows[i] * rows[i];
  const float2 squares = sums_of_halves(products);
  return (float2)(squares.x < 1e-10f ? 0.0f : 1.0f / sqrt(squares.x),
                  squares.y < 1e-10f ? 0.0f : 1.0f / sqrt(squares.y));
}

// The most similar pair of sides of two edges: 0 dark, 1 bright.
typedef struct {
  int first, second;
  float ncc;
} Pairing;

static inline void try_pairing(const float product, const float norms, const int first, const int second,
                               Pairing* best) {
  const float ncc = norms > 0.0f ? product * norms : -1.0f;
  if (!(ncc > best->ncc)) return;
  best->first = first;
  best->second = second;
  best->ncc = ncc;
}

// \param norms the inverse ones
static inline void best_pairing(const float16* a, const float2 norms_a, const float16* b, const float2 norms_b,
                                Pairing* best) {
  float16 same = 0.0f, crossed = 0.0f;
  for (int i = 0; i < kPaperPatchRows; ++i) {
    same += a[i] * b[i];
    crossed += a[i] * HALVES_SWAPPED(b[i]);
  }
  const float2 same_sums = sums_of_halves(same), crossed_sums = sums_of_halves(crossed);
  best->first = best->second = 0;
  best->ncc = -1.0f;
  try_pairing(same_sums.x, norms_a.x * norms_b.x, 0, 0, best);
  try_pairing(same_sums.y, norms_a.y * norms_b.y, 1, 1, best);
  try_pairing(crossed_sums.x, norms_a.x * norms_b.y, 0, 1, best);
  try_pairing(crossed_sums.y, norms_a.y * norms_b.x, 1, 0, best);
}

// The patches of edge i as paper_patches.cl stores them; returns their inverse norms.
static inline float2 load_sides(global const float* patches, const int i, float16* rows) {
  global const float* from = patches + (size_t)i * kPaperPatchFloats;
  for (int k = 0; k < kPaperPatchRows; ++k) rows[k] = ((global const float16*)from)[k];
  return ((global const float2*)(from + kPaperInverseNorms))[0];
}
