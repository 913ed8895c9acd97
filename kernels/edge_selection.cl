// edge_selection.cl: selects the maxima that become edges: those where a curve crosses one of evenly spaced epipolar
// lines. doc/method.md section 1.
//
// Needs edge_detection.cl. In: the maxima of edge_detection_strip.cl (rows: packed at the start of their row) or, with
// AT_PIXELS, of edge_detection_tile.cl (flags over the image), which it thins out in place. An image's epipolar lines
// are numbered by EpipolarRows in the same way in both images, so that an edge and its counterpart are kept together.
// The maxima of both images are weighed by their number of edges at a spacing of 1 px, which determines the spacing.
// All sums are integers, so their order does not matter. Reference: host/workbench/reference/edge_detection.cpp.

// The functions below for one maximum and for sixteen, with the same operations: T is float or float16, I int or int16.
// crossing: the number of the epipolar line of a maximum; step: its difference between neighbouring maxima of the
// curve; sine: of the angle between curve and line. The longer component of the tangent is 1, because neighbouring
// maxima are a pixel apart along it.
// density: where a curve meets the lines at a small angle, the lines are closer, so that edges keep their distance: 1,
// 1/2, 1/4, 1/8 or 1/16 of the spacing.
// meets: true for the maximum of a curve that is nearest to a line of the lattice. width: 1; with 1.5, every other line
// has two of them.
// chosen: positions and directions of the two images differ slightly, so the searched image also keeps the neighbours,
// and the maxima of neighbouring densities.
// weight: the number of edges that a maximum contributes at a spacing of 1 px, times kSelectionUnit.
#define CONVERT_TO_int convert_int
#define CONVERT_TO_int16 convert_int16
#define DEFINE_LATTICE(T, I, SUFFIX)                                                                            \
  static inline T crossing##SUFFIX(const SelectionArguments* args, const T x, const T y, const T code, T* step, \
                                   T* sine) {                                                                   \
    const I steep = code >= 512.0f;                                                                             \
    const T ratio = select(code, code - 512.0f, steep) / 255.5f - 1.0f;                                         \
    const T tangent_x = select((T)1.0f, -ratio, steep), tangent_y = select(-ratio, (T)1.0f, steep);             \
    const EpipolarRows rows = args->rows;                                                                       \
    const T depth = rows.forward_x * x + rows.forward_y * y + rows.forward_1;                                   \
    const T plane = (rows.across_x * x + rows.across_y * y + rows.across_1) / depth;                            \
    const T bend_x = rows.bend_xx * x + rows.bend_xy * y, bend_y = rows.bend_yy * y;                            \
    const T row = plane - (bend_x * x + bend_y * y);                                                            \
    const T by_x = (rows.across_x - plane * rows.forward_x) / depth - (bend_x + rows.bend_xx * x);              \
    const T by_y = (rows.across_y - plane * rows.forward_y) / depth - (2.0f * bend_y + rows.bend_xy * x);       \
    const T rise = fabs(tangent_x * by_x + tangent_y * by_y);                                                   \
    *step = rise;                                                                                               \
    *sine = rise / sqrt((1.0f + ratio * ratio) * (by_x * by_x + by_y * by_y));                                  \
    return row;                                                                                                 \
  }                                                                                                             \
  static inline T density##SUFFIX(const T sine) {                                                               \
    T density = select((T)1.0f, (T)0.5f, sine < 0.70710678f);                                                   \
    density = select(density, (T)0.25f, sine < 0.35355339f);                                                    \
    density = select(density, (T)0.125f, sine < 0.17677670f);                                                   \
    return select(density, (T)0.0625f, sine < 0.08838835f);                                                     \
  }                                                                                                             \
  static inline I meets##SUFFIX(const T row, const T step, const T spacing, const float width) {                \
    const T distance = row - spacing * rint(row / spacing), reach = 0.5f * width * step;                        \
    return distance >= -reach && distance < reach;                                                              \
  }                                                                                                             \
  static inline I chosen##SUFFIX(const SelectionArguments* args, const T x, const T y, const T code,            \
                                 const float spacing) {                                                         \
    T step, sine;                                                                                               \
    const T row = crossing##SUFFIX(args, x, y, code, &step, &sine);                                             \
    const float width = args->slack > 1.0f ? kSearchedWidth : 1.0f;                                             \
    I chosen = meets##SUFFIX(row, step, spacing * density##SUFFIX(sine), width);                                \
    if (args->slack > 1.0f) {                                                                                   \
      chosen = chosen || meets##SUFFIX(row, step, spacing * density##SUFFIX(sine * args->slack), width);        \
      chosen = chosen || meets##SUFFIX(row, step, spacing * density##SUFFIX(sine / args->slack), width);        \
    }                                                                                                           \
    return chosen && sine >= args->min_sine;                                                                    \
  }                                                                                                             \
  static inline I weight##SUFFIX(const SelectionArguments* args, const T x, const T y, const T code) {          \
    T step, sine;                                                                                               \
    crossing##SUFFIX(args, x, y, code, &step, &sine);                                                           \
    const I weight = CONVERT_TO_##I(rint((float)kSelectionUnit * step / density##SUFFIX(sine)));                \
    return select((I)0, weight, sine >= args->min_sine);                                                        \
  }
DEFINE_LATTICE(float, int, )
#ifndef AT_PIXELS
DEFINE_LATTICE(float16, int16, 16)
#endif

// spacing[0] = distance of the lattice's lines [px] by edges.budget and edges.max_spacing (`most`); 0: all maxima are
// kept. The tally starts anew. One work-item.
kernel void edge_selection_spacing(const int budget, const float most, global int* tally, global float* spacing) {
  const float even = (float)max(tally[0], tally[1]) / ((float)kSelectionUnit / kSelectionSample * (float)budget);
  const float wanted = max(min(even, most), even / kDenseBudget);
  spacing[0] = wanted > kClosestSelection ? rint(wanted * kSelectionSteps) / kSelectionSteps : 0.0f;
  tally[0] = tally[1] = 0;
}

#ifdef AT_PIXELS

// tally[image] += the weights of the maxima of every kSelectionSample-th row. One work-group of GROUP per such row,
// which adds its sum once.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void edge_selection_weigh_pixels(
    const SelectionArguments args, global const float* winners, global const uchar* flags, const int image,
    global int* tally) {
  local int sums[GROUP];
  const int item = (int)get_local_id(0);
  const size_t first = (size_t)get_group_id(0) * kSelectionSample * args.width;
  int sum = 0;
  for (int i = item; i < args.width; i += GROUP)
    if (flags[first + i]) {
      const float4 winner = ((global const float4*)winners)[first + i];
      sum += weight(&args, winner.x, winner.y, winner.w);
    }
  sums[item] = sum;
  for (int distance = GROUP / 2; distance > 0; distance /= 2) {
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < distance) sums[item] += sums[item + distance];
  }
  if (item == 0 && sums[0] > 0) atomic_add(tally + image, sums[0]);
}

// Clears the flags of the maxima that are not selected. One work-item per pixel.
kernel void edge_selection_pixels(const SelectionArguments args, global const float* spacing_of_frame,
                                  global const float* winners, global uchar* flags) {
  const size_t pixel = get_global_id(0);
  const float spacing = spacing_of_frame[0];
  if (pixel >= (size_t)args.width * args.height || spacing == 0.0f || !flags[pixel]) return;
  const float4 winner = ((global const float4*)winners)[pixel];
  flags[pixel] = (uchar)chosen(&args, winner.x, winner.y, winner.w, spacing);
}

#else

// x, y and code of the sixteen maxima at `maximum`.
static inline void transpose_maxima(global const float* maximum, float16* x, float16* y, float16* code) {
  const float16 a = LOAD(maximum), b = LOAD(maximum + 16), c = LOAD(maximum + 32), d = LOAD(maximum + 48);
  *x = (float16)(a.s048c, b.s048c, c.s048c, d.s048c);
  *y = (float16)(a.s159d, b.s159d, c.s159d, d.s159d);
  *code = (float16)(a.s37bf, b.s37bf, c.s37bf, d.s37bf);
}

// Both kernels take sixteen maxima of a row at a time. Values read beyond the last one are not used
// (kMaximaAtOnce of them follow the last row).

// tally[image] += the weights of the maxima of every kSelectionSample-th row. One work-item per such row.
kernel void edge_selection_weigh_rows(const SelectionArguments args, global const float* winners,
                                      global const int* counts, const int image, global int* tally) {
  const int row = kSelectionSample * (int)get_global_id(0);
  if (row >= args.height) return;
  const int16 lanes = (int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  int16 sums = 0;
  global const float* in_row = winners + (size_t)row * 4 * args.width;
  for (int begin = 0; begin < counts[row]; begin += 16) {
    float16 x, y, code;
    transpose_maxima(in_row + 4 * begin, &x, &y, &code);
    sums += weight16(&args, x, y, code) & (begin + lanes < counts[row]);
  }
  const int8 eight = sums.lo + sums.hi;
  const int4 four = eight.lo + eight.hi;
  const int2 two = four.lo + four.hi;
  if (two.x + two.y > 0) atomic_add(tally + image, two.x + two.y);
}

// Keeps the selected maxima of a row, in their order. One work-item per row.
kernel void edge_selection_rows(const SelectionArguments args, global const float* spacing_of_frame,
                                global float* winners, global int* counts) {
  const int row = (int)get_global_id(0);
  const float spacing = spacing_of_frame[0];
  if (row >= args.height || spacing == 0.0f) return;
  global float* in_row = winners + (size_t)row * 4 * args.width;
  const int count = counts[row];
  int kept = 0;
  for (int begin = 0; begin < count; begin += 16) {
    float16 x, y, code;
    transpose_maxima(in_row + 4 * begin, &x, &y, &code);
    uint keep = lane_bits(chosen16(&args, x, y, code, spacing));
    if (count - begin < 16) keep &= (1u << (uint)(count - begin)) - 1u;
    for (; keep != 0u; keep &= keep - 1u) vstore4(vload4(begin + lowest_bit(keep), in_row), kept++, in_row);
  }
  counts[row] = kept;
}

#endif
