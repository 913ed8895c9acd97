// sift.cl: SIFT descriptors of both sides of an edge at one fixed scale (doc/method.md section 2; Lowe 2004, section
// 6).
//
// The gradient of the blurred image is made once per image, in three passes over planes of `stride` floats per row.
// Pixel (x, y) of the planes of the blur stands at y * stride + kSiftPadding + x; the maps also have kSiftPadding rows
// above and below, so that samples need no bounds check: outside the image and on its outermost pixels the
// magnitude is zero.
// stride = kSiftPadding + width rounded up to 8 + kSiftPadding. One work-item = 8 pixels of a row.
// sift_blur_down   In: image (width x height, packed). Out: blurred along y; columns -8 .. width rounded up + 8.
// sift_blur_along  In: that plane. Out: blurred along x too; columns 0 .. width rounded up.
// sift_gradient    In: that plane. Out: magnitude [grey levels per 2 px] and angle [bins of 45 degrees, -4 .. 4] of the
//                  central difference, (height + 2 kSiftPadding) rows.
// sift_describe    In: both maps, edges (x, y [px], direction [rad]). Out: 256 bytes per edge, laid out as in
//                  host/workbench/reference/edge_descriptions.hpp. Two forms with the same arithmetic in one order:
//                  without GROUP: one work-item = one edge; the 8 angle bins of a cell are the lanes of a float8;
//                  with GROUP: kSiftItems work-items per edge, each a cell of one side; groups of GROUP work-items,
//                  local memory 28 * 121 bytes + 1 KiB per edge.
// Needs direction.cl before it. Reference: host/workbench/reference/edge_descriptions.cpp.

#define RADIUS 5
#define WINDOW (2 * RADIUS + 1)
#define CELL_WIDTH 1.5f
#define CLIP 0.2f
#define NORM 512.0f

// Normalised Gaussian weights of the middle tap and its six neighbours; variance 1.6^2 - 0.5^2.
constant float kBlur[7] = {0.262488298f,   0.211400891f,   0.110432628f,   0.0374181004f,
                           0.00822355864f, 0.00117228061f, 0.000108391968f};
// exp(-k^2 / 18) for k = -5 .. 5: the window's Gaussian has a standard deviation of 2 cells = 3 px. Padded for two
// vectors.
constant float kWindow[16] = {0.249352209f, 0.411112291f, 0.60653066f, 0.800737403f, 0.945959469f, 1.0f,
                              0.945959469f, 0.800737403f, 0.60653066f, 0.411112291f, 0.249352209f};

// Index inside [0, size) after reflection about the outermost pixels.
static inline int reflect(int i, const int size) {
  if (size == 1) return 0;
  while (i < 0 || i >= size) i = i < 0 ? -i : 2 * (size - 1) - i;
  return i;
}

static inline float8 pixels8(global const Pixel* row, const int x, const int width) {
  if (x >= 0 && x + 8 <= width) return convert_float8(vload8(0, row + x)) * GREY_PER_VALUE;
  float values[8];
  for (int k = 0; k < 8; ++k) values[k] = (float)row[reflect(x + k, width)] * GREY_PER_VALUE;
  return vload8(0, values);
}

kernel IN_VECTORS void sift_blur_down(global const uchar* bytes, const int width, const int height, const int stride,
                                      global float* plane) {
  const int x = (int)get_global_id(0) * 8 - 8, y = (int)get_global_id(1);
  global const Pixel* image = (global const Pixel*)bytes;
  if (x >= stride - 2 * kSiftPadding + 8 || y >= height) return;
  float8 sum = kBlur[0] * pixels8(image + y * width, x, width);
  for (int k = 1; k < 7; ++k) {
    sum += kBlur[k] * (pixels8(image + reflect(y - k, height) * width, x, width) +
                       pixels8(image + reflect(y + k, height) * width, x, width));
  }
  vstore8(sum, 0, plane + (size_t)y * stride + kSiftPadding + x);
}

kernel IN_VECTORS void sift_blur_along(global const float* plane, const int height, const int stride,
                                       global float* blurred) {
  const int x = (int)get_global_id(0) * 8, y = (int)get_global_id(1);
  if (x >= stride - 2 * kSiftPadding || y >= height) return;
  global const float* p = plane + (size_t)y * stride + kSiftPadding + x;
  float8 sum = kBlur[0] * vload8(0, p);
  for (int k = 1; k < 7; ++k) sum += kBlur[k] * (vload8(0, p - k) + vload8(0, p + k));
  vstore8(sum, 0, blurred + (size_t)y * stride + kSiftPadding + x);
}

kernel IN_VECTORS void sift_gradient(global const float* blurred, const int width, const int height, const int stride,
                                     global float* magnitude, global float* angle) {
  const int column = (int)get_global_id(0) * 8, row = (int)get_global_id(1);
  if (column >= stride || row >= height + 2 * kSiftPadding) return;
  const int x = column - kSiftPadding, y = row - kSiftPadding;
  float8 length = 0.0f, bins = 0.0f;
  if (y >= 1 && y < height - 1 && x >= 0 && x < width) {
    global const float* p = blurred + (size_t)y * stride + column;
    const float8 dx = vload8(0, p + 1) - vload8(0, p - 1), dy = vload8(0, p + stride) - vload8(0, p - stride);
    const int8 columns = x + (int8)(0, 1, 2, 3, 4, 5, 6, 7);
    const int8 inside = (columns >= 1) & (columns < width - 1);
    length = as_float8(as_int8(sqrt(dx * dx + dy * dy)) & inside);
    bins = as_float8(as_int8(atan2(dy, dx) * (kSiftAngles / (2.0f * PI_F))) & inside);
  }
  vstore8(length, 0, magnitude + (size_t)row * stride + column);
  vstore8(bins, 0, angle + (size_t)row * stride + column);
}

// Nearest pixel of a key point, limited to the surroundings of the image so that all samples are inside the maps
// (beyond, they would all be zero).
static inline int nearest(const float coordinate, const int size) {
  return (int)clamp(rint(coordinate), -(float)(RADIUS + 1), (float)(size + RADIUS));
}

// The window of both sides of an edge.
typedef struct {
  float c, s;        // cosine and sine of the direction, in cells per px
  float turn;        // the direction, in angle bins
  int dark, bright;  // where the samples of either side begin in the maps
} SiftWindow;

static inline int first_sample(const SiftArguments* args, const float x, const float y) {
  return (nearest(y, args->height) + kSiftPadding - RADIUS) * args->stride + nearest(x, args->width) + kSiftPadding -
         RADIUS;
}

static inline SiftWindow window_of(const SiftArguments* args, global const float* positions, const int edge) {
  global const float* place = positions + args->edges.first + edge;
  const float x = place[0], y = place[args->edges.stride], direction = place[2 * args->edges.stride];
  float cosine;
  const float sine = sine_cosine(direction, &cosine);
  const float to_dark_x = args->offset * sine, to_dark_y = -args->offset * cosine;
  const SiftWindow window = {
      cosine * (1.0f / CELL_WIDTH), sine * (1.0f / CELL_WIDTH), direction * (kSiftAngles / (2.0f * PI_F)),
      first_sample(args, x + to_dark_x, y + to_dark_y), first_sample(args, x - to_dark_x, y - to_dark_y)};
  return window;
}

#ifndef GROUP

#define ROW (kSiftCells + 2)  // cells with a ring around them for samples outside

constant int8 kAngleMask[kSiftAngles] = {(int8)(-1, 0, 0, 0, 0, 0, 0, 0), (int8)(0, -1, 0, 0, 0, 0, 0, 0),
                                         (int8)(0, 0, -1, 0, 0, 0, 0, 0), (int8)(0, 0, 0, -1, 0, 0, 0, 0),
                                         (int8)(0, 0, 0, 0, -1, 0, 0, 0), (int8)(0, 0, 0, 0, 0, -1, 0, 0),
                                         (int8)(0, 0, 0, 0, 0, 0, -1, 0), (int8)(0, 0, 0, 0, 0, 0, 0, -1)};

// Clip, normalise and round the histogram of one side.
static inline void store_descriptor(const float8* histogram, global uchar* descriptor) {
  float8 squares = 0.0f;
  for (int cell = 0; cell < kSiftCells * kSiftCells; ++cell) {
    const float8 bins = histogram[(cell / kSiftCells + 1) * ROW + cell % kSiftCells + 1];
    squares += bins * bins;
  }
  const float clip = CLIP * sqrt(sum8(squares));
  squares = 0.0f;
  for (int cell = 0; cell < kSiftCells * kSiftCells; ++cell) {
    const float8 bins = min(histogram[(cell / kSiftCells + 1) * ROW + cell % kSiftCells + 1], clip);
    squares += bins * bins;
  }
  const float norm = sqrt(sum8(squares));
  const float scale = norm > 0.0f ? NORM / norm : 0.0f;
  for (int cell = 0; cell < kSiftCells * kSiftCells; cell += 2) {
    const float8* bins = histogram + (cell / kSiftCells + 1) * ROW + cell % kSiftCells + 1;
    const uchar8 even = convert_uchar8(convert_int8(min(min(bins[0], clip) * scale, 255.0f) + 0.5f));
    const uchar8 odd = convert_uchar8(convert_int8(min(min(bins[1], clip) * scale, 255.0f) + 0.5f));
    // As four words: PoCL's vstore16 would store the bytes one by one.
    ((global uint4*)descriptor)[cell / 2] = as_uint4((uchar16)(even, odd));
  }
}

// One side's samples of a row: weights of the two angle bins next to each, and the lower one.
static inline void sample_row(global const float* magnitude, global const float* angle, const int first,
                              const float turn, float8* low, float8* high, int8* bin) {
#pragma unroll
  for (int block = 0; block < 2; ++block) {
    const float8 length = vload8(block, magnitude + first);
    const float8 bins = turn - vload8(block, angle + first);
    const int8 whole = whole_below8(bins);
    const float8 part = bins - convert_float8(whole);
    low[block] = length * (1.0f - part);
    high[block] = length * part;
    bin[block] = whole & (kSiftAngles - 1);
  }
}

// The two weights in their angle bins, zeros elsewhere.
static inline float8 two_bins(const float low, const float high, const int bin) {
  const int8 lower = kAngleMask[bin], upper = kAngleMask[(bin + 1) & (kSiftAngles - 1)];
  return as_float8((as_int8((float8)(low)) & lower) | (as_int8((float8)(high)) & upper));
}

// Lane k of two concatenated vectors.
#define LANE(T, vectors, k) ((const T*)(vectors))[k]

// LONG: the histogram stays in registers from the first sample to the last byte.
kernel IN_VECTORS void sift_describe(const SiftArguments args, global const float* magnitude, global const float* angle,
                                     global const float* positions, global uchar* descriptors) {
  const int edge = (int)get_global_id(0);
  if (edge >= args.edges.count) return;
  const SiftWindow window = window_of(&args, positions, edge);
  const float c = window.c, s = window.s;

  float8 dark[ROW * ROW], bright[ROW * ROW];
  for (int k = 0; k < ROW * ROW; ++k) dark[k] = bright[k] = 0.0f;

  // Samples of a row inside the window: |j c + i s| < 2.5 and |i c - j s| < 2.5. A c or s that is nearly 0 bounds
  // nothing.
  const float by_c = 1.0f / copysign(max(fabs(c), 1e-3f), c), by_s = 1.0f / copysign(max(fabs(s), 1e-3f), s);
  const float reach_c = fabs(2.5f * by_c), reach_s = fabs(2.5f * by_s);

  for (int row = 0; row < WINDOW; ++row) {
    const float i = (float)(row - RADIUS);
    const float middle_c = -i * s * by_c, middle_s = i * c * by_s;
    const float from = max(max(middle_c - reach_c, middle_s - reach_s) - 1e-3f + RADIUS, 0.0f);
    const float to = min(min(middle_c + reach_c, middle_s + reach_s) + 1e-3f + RADIUS, 2.0f * RADIUS);
    const int first = -whole_below(-from), last = whole_below(to);
    if (last < first) continue;

    float8 w00[2], w01[2], w10[2], w11[2];
    int8 cells[2];
#pragma unroll
    for (int block = 0; block < 2; ++block) {
      const float8 j = (float)(8 * block - RADIUS) + (float8)(0, 1, 2, 3, 4, 5, 6, 7);
      const float8 along = j * c + i * s, across = i * c - j * s;
      const int8 inside = (fabs(along) < 2.5f) & (fabs(across) < 2.5f);
      const float8 place_along = along + 1.5f, place_across = across + 1.5f;
      const int8 cell_along = whole_below8(place_along), cell_across = whole_below8(place_across);
      const float8 part_along = place_along - convert_float8(cell_along);
      const float8 part_across = place_across - convert_float8(cell_across);
      const float8 weight = as_float8(as_int8(kWindow[row] * vload8(block, kWindow)) & inside);
      const float8 beyond = weight * part_across, before = weight * (1.0f - part_across);
      w00[block] = before * (1.0f - part_along);
      w01[block] = before * part_along;
      w10[block] = beyond * (1.0f - part_along);
      w11[block] = beyond * part_along;
      cells[block] = (cell_across * ROW + cell_along + (ROW + 1)) & inside;
    }
    float8 dark_low[2], dark_high[2], bright_low[2], bright_high[2];
    int8 dark_bin[2], bright_bin[2];
    const int down = row * args.stride;
    sample_row(magnitude, angle, window.dark + down, window.turn, dark_low, dark_high, dark_bin);
    sample_row(magnitude, angle, window.bright + down, window.turn, bright_low, bright_high, bright_bin);
    for (int k = first; k <= last; ++k) {
      const int cell = LANE(int, cells, k), bin_dark = LANE(int, dark_bin, k), bin_bright = LANE(int, bright_bin, k);
      const float8 in_dark = two_bins(LANE(float, dark_low, k), LANE(float, dark_high, k), bin_dark);
      const float8 in_bright = two_bins(LANE(float, bright_low, k), LANE(float, bright_high, k), bin_bright);
      float8* dark_cell = dark + cell;
      float8* bright_cell = bright + cell;
      dark_cell[0] += in_dark * LANE(float, w00, k);
      dark_cell[1] += in_dark * LANE(float, w01, k);
      dark_cell[ROW] += in_dark * LANE(float, w10, k);
      dark_cell[ROW + 1] += in_dark * LANE(float, w11, k);
      bright_cell[0] += in_bright * LANE(float, w00, k);
      bright_cell[1] += in_bright * LANE(float, w01, k);
      bright_cell[ROW] += in_bright * LANE(float, w10, k);
      bright_cell[ROW + 1] += in_bright * LANE(float, w11, k);
    }
  }
  global uchar* descriptor = descriptors + (size_t)edge * (kEdgeSiftBytes);
  store_descriptor(dark, descriptor);
  store_descriptor(bright, descriptor + kSiftBytes);
}

#else

#define SIDES 2
#define EDGES_PER_GROUP (GROUP / kSiftItems)

// LONG: the histogram stays in registers from the first sample to the last byte.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void sift_describe(const SiftArguments args,
                                                                             global const float* magnitude,
                                                                             global const float* angle,
                                                                             global const float* positions,
                                                                             global uchar* descriptors) {
  // What each sample of the window is, the same for both sides except the gradient.
  local int2
      corner[EDGES_PER_GROUP][WINDOW * WINDOW];  // cells across and along, the lower ones; outside the window: -9
  local float4 shares[EDGES_PER_GROUP][WINDOW * WINDOW];
  local float2 gradient[EDGES_PER_GROUP][SIDES][WINDOW * WINDOW];  // weights of the two angle bins
  local int lower_bin[EDGES_PER_GROUP][SIDES][WINDOW * WINDOW];
  local float histogram[EDGES_PER_GROUP][SIDES][kSiftBytes];

  const int count = args.edges.count;
  const int local_edge = (int)get_local_id(0) / kSiftItems, item = (int)get_local_id(0) % kSiftItems;
  const int wanted = (int)(get_global_id(0) / kSiftItems);
  const int edge =
      min(wanted, count - 1);  // surplus work-items repeat the last edge, since all must reach the barriers
  const SiftWindow around = window_of(&args, positions, edge);
  const float c = around.c, s = around.s;

  for (int k = item; k < WINDOW * WINDOW; k += kSiftItems) {
    const int row = k / WINDOW, column = k % WINDOW;
    const float i = (float)(row - RADIUS), j = (float)(column - RADIUS);
    const float along = j * c + i * s, across = i * c - j * s;
    const bool inside = fabs(along) < 2.5f && fabs(across) < 2.5f;
    const float place_along = along + 1.5f, place_across = across + 1.5f;
    const int below_along = whole_below(place_along), below_across = whole_below(place_across);
    const float part_along = place_along - (float)below_along, part_across = place_across - (float)below_across;
    const float window = kWindow[row] * kWindow[column];
    const float beyond = window * part_across, before = window * (1.0f - part_across);
    corner[local_edge][k] = inside ? (int2)(below_across, below_along) : (int2)(-9);
    shares[local_edge][k] =
        (float4)(before * (1.0f - part_along), before * part_along, beyond * (1.0f - part_along), beyond * part_along);
    for (int side = 0; side < SIDES; ++side) {
      const int position = (side == 0 ? around.dark : around.bright) + row * args.stride + column;
      const float length = magnitude[position], bins = around.turn - angle[position];
      const int whole = whole_below(bins);
      const float part = bins - (float)whole;
      gradient[local_edge][side][k] = (float2)(length * (1.0f - part), length * part);
      lower_bin[local_edge][side][k] = whole & (kSiftAngles - 1);
    }
  }
  barrier(CLK_LOCAL_MEM_FENCE);

  const int side = item / (kSiftCells * kSiftCells), cell = item % (kSiftCells * kSiftCells);
  const int cell_across = cell / kSiftCells, cell_along = cell % kSiftCells;
  const int8 lanes = (int8)(0, 1, 2, 3, 4, 5, 6, 7);
  float8 bins = 0.0f;
  for (int k = 0; k < WINDOW * WINDOW; ++k) {
    const int below = cell_across - corner[local_edge][k].x, right = cell_along - corner[local_edge][k].y;
    if ((below | right) & ~1) continue;
    const float4 share = shares[local_edge][k];
    const float weight = below ? (right ? share.w : share.z) : (right ? share.y : share.x);
    const float2 low_high = gradient[local_edge][side][k];
    const int lower = lower_bin[local_edge][side][k];
    bins += select(select((float8)(0.0f), (float8)(low_high.x), lanes == lower), (float8)(low_high.y),
                   lanes == ((lower + 1) & (kSiftAngles - 1))) *
            weight;
  }
  local float* all = histogram[local_edge][side];
  vstore8(bins, cell, all);
  barrier(CLK_LOCAL_MEM_FENCE);
  float8 squares = 0.0f;
  for (int k = 0; k < kSiftCells * kSiftCells; ++k) {
    const float8 other = vload8(k, all);
    squares += other * other;
  }
  const float clip = CLIP * sqrt(sum8(squares));
  squares = 0.0f;
  for (int k = 0; k < kSiftCells * kSiftCells; ++k) {
    const float8 other = min(vload8(k, all), clip);
    squares += other * other;
  }
  const float norm = sqrt(sum8(squares));
  const float scale = norm > 0.0f ? NORM / norm : 0.0f;
  if (wanted >= count) return;
  global uchar8* descriptor = (global uchar8*)(descriptors + (size_t)edge * kEdgeSiftBytes + side * kSiftBytes);
  descriptor[cell] = convert_uchar8(convert_int8(min(min(bins, clip) * scale, 255.0f) + 0.5f));
}

#endif
