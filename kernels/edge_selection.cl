// edge_selection.cl: which maxima become edges, before anything else is spent on them: those where a curve crosses one
// of evenly spaced epipolar lines. doc/method.md section 1.
//
// Needs edge_detection.cl. In: the maxima of edge_detection_strip.cl (rows: packed at the start of their row) or of
// edge_detection_tile.cl (cells: flags over the grid), which it thins out in place. An image's epipolar lines are
// numbered by EpipolarRows, alike in both images, so that an edge and its counterpart stay together.
// First the maxima of both images are weighed with what each would add at a spacing of 1 px, then the spacing follows
// from the budget, then the maxima are chosen. Sums are integers, whose order does not matter.
// Reference: host/reference/edge_selection.cpp.

// What a maximum means to the lattice.
typedef struct {
  float row;   // number of its epipolar line
  float step;  // by which the numbers of neighbouring maxima along the curve differ
  float sine;  // of the angle between curve and epipolar line
} Crossing;

inline Crossing crossing(const SelectionArguments* args, const float4 winner) {
  const float code = (winner.w - floor(winner.w)) * 1024.0f;
  const int steep = code >= 512.0f;
  const float ratio = (steep ? code - 512.0f : code) / 255.5f - 1.0f;
  // The tangent, longer component 1: neighbouring maxima are half a pixel apart along it.
  const float tangent_x = steep ? -ratio : 1.0f, tangent_y = steep ? 1.0f : -ratio;
  const EpipolarRows rows = args->rows;
  const float depth = rows.forward_x * winner.x + rows.forward_y * winner.y + rows.forward_1;
  Crossing result;
  result.row = (rows.across_x * winner.x + rows.across_y * winner.y + rows.across_1) / depth;
  const float by_x = (rows.across_x - result.row * rows.forward_x) / depth,
              by_y = (rows.across_y - result.row * rows.forward_y) / depth;
  const float rise = fabs(tangent_x * by_x + tangent_y * by_y);
  result.step = 0.5f * rise;
  result.sine = rise / sqrt((1.0f + ratio * ratio) * (by_x * by_x + by_y * by_y));
  return result;
}

// Lines that a curve meets under a small angle are asked for more densely, so that its edges keep their distance: every
// 1, 1/2, 1/4 ... of the spacing.
inline float density_of(const float sine) {
  float density = 1.0f;
  while (sine < 0.70710678f * density && density > 0.01f) density *= 0.5f;
  return density;
}

// Is this the maximum of its curve that is nearest to a line of the lattice? width: 1; 1.5 gives every other line two of
// them.
inline int meets(const Crossing at, const float spacing, const float width) {
  const float distance = at.row - spacing * rint(at.row / spacing), reach = 0.5f * width * at.step;
  return distance >= -reach && distance < reach;
}

inline int is_chosen(const SelectionArguments* args, const float4 winner, const float spacing) {
  const Crossing at = crossing(args, winner);
  if (at.sine < args->min_sine) return 0;
  if (args->slack == 1.0f) return meets(at, spacing * density_of(at.sine), 1.0f);
  // Positions and directions of the two images differ a little: the searched image keeps the neighbours too, and what a
  // neighbouring density asks for.
  return meets(at, spacing * density_of(at.sine), kSearchedWidth) ||
         meets(at, spacing * density_of(fmin(at.sine * args->slack, 1.0f)), kSearchedWidth) ||
         meets(at, spacing * density_of(at.sine / args->slack), kSearchedWidth);
}

// How many edges a maximum stands for at a spacing of 1 px, times kSelectionUnit.
inline int weight_of(const SelectionArguments* args, const float4 winner) {
  const Crossing at = crossing(args, winner);
  return at.sine < args->min_sine ? 0 : (int)rint((float)kSelectionUnit * at.step / density_of(at.sine));
}

// tally[image] += the weights of all maxima. One work-item per row of the doubled grid.
kernel void edge_selection_weigh_rows(const SelectionArguments args, global const float* winners,
                                      global const int* counts, const int image, global int* tally) {
  const int row = (int)get_global_id(0);
  if (row >= 2 * args.height) return;
  global const float* in_row = winners + (size_t)row * 8 * args.width;
  int sum = 0;
  for (int i = 0; i < counts[row]; ++i) sum += weight_of(&args, vload4(i, in_row));
  if (sum > 0) atomic_add(tally + image, sum);
}

// The same of flagged cells. One work-item per cell.
kernel void edge_selection_weigh_cells(const SelectionArguments args, global const float* winners,
                                       global const uchar* flags, const int image, global int* tally) {
  const size_t cell = get_global_id(0);
  if (cell >= 4 * (size_t)args.width * args.height || !flags[cell]) return;
  const int weight = weight_of(&args, vload4(cell, winners));
  if (weight > 0) atomic_add(tally + image, weight);
}

// spacing[0] = distance of the lattice's lines at which the image with more edges has about `budget` of them [px]; 0:
// all maxima are kept. The tally starts anew. One work-item.
kernel void edge_selection_spacing(const int budget, global int* tally, global float* spacing) {
  if (get_global_id(0) > 0) return;
  const float wanted = (float)max(tally[0], tally[1]) / ((float)kSelectionUnit * (float)budget);
  spacing[0] = wanted > kClosestSelection ? wanted : 0.0f;
  tally[0] = tally[1] = 0;
}

// Keeps the chosen maxima of a row, in their order. One work-item per row of the doubled grid.
kernel void edge_selection_rows(const SelectionArguments args, global const float* spacing_of_frame,
                                global float* winners, global int* counts) {
  const int row = (int)get_global_id(0);
  const float spacing = spacing_of_frame[0];
  if (row >= 2 * args.height || spacing == 0.0f) return;
  global float* in_row = winners + (size_t)row * 8 * args.width;
  int kept = 0;
  for (int i = 0; i < counts[row]; ++i) {
    const float4 winner = vload4(i, in_row);
    if (is_chosen(&args, winner, spacing)) vstore4(winner, kept++, in_row);
  }
  counts[row] = kept;
}

// Takes the flag of the maxima that are not chosen. One work-item per cell.
kernel void edge_selection_cells(const SelectionArguments args, global const float* spacing_of_frame,
                                 global const float* winners, global uchar* flags) {
  const size_t cell = get_global_id(0);
  const float spacing = spacing_of_frame[0];
  if (cell >= 4 * (size_t)args.width * args.height || spacing == 0.0f || !flags[cell]) return;
  flags[cell] = is_chosen(&args, vload4(cell, winners), spacing);
}
