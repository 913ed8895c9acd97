// paper_refinement.cl: refines the alive candidates of every row, along the epipolar line in stereo, freely in time.
//
// Needs direction.cl, epipolar.cl and paper_sides.cl. In: both pictures (paper_patches.cl), edges, candidate lists;
// with both_sides = 0 also the patches of both. Out: x and y [px] of every alive candidate, in two blocks.
// Gauss-Newton with Huber weights on the differences of mean-free patches. Sums are in single precision: rounding moves
// a result by less than the tolerance of the steps.
// One work-item = one row.
// Reference: host/workbench/paper/side_patches.cpp.

// What the patches of a candidate have to look like: rows of the sides that take part, as lanes of the moving patch.
typedef struct {
  float16 rows[kPaperPatchRows];
  int16 lanes;    // -1 of the samples that take part
  float samples;  // their number
} Goal;

INLINED void prepare_goal(const float16* fixed, const int both_sides, const Pairing pairing, Goal* goal) {
  const int8 side = (int8)(-1, -1, -1, -1, -1, -1, -1, 0);
  const int crossed = !both_sides && pairing.first != pairing.second;
  for (int i = 0; i < kPaperPatchRows; ++i) goal->rows[i] = crossed ? HALVES_SWAPPED(fixed[i]) : fixed[i];
  goal->lanes = (int16)(both_sides || pairing.second == 0 ? side : (int8)(0),
                        both_sides || pairing.second == 1 ? side : (int8)(0));
  goal->samples = (float)(kPaperPatchRows * kPaperPatchRows * (both_sides ? 2 : 1));
}

// Sum of all lanes.
static inline float sum_of(const float16 v) {
  const float2 sums = sums_of_halves(v);
  return sums.x + sums.y;
}

// A move of a candidate, and what remains between the patches before its last step.
typedef struct {
  float x, y;         // px
  float mean_square;  // grey levels^2
} Move;

// Normal equations of a step, in the frame of the axis: along it, and with `is_free` also across it.
typedef struct {
  float along2, both, across2, pull_along, pull_across, squares;
} Equations;

// Tilted: the axis is not parallel to x, or the move is free. Clamped: see place_rows().
INLINED void equations_at(const Picture picture, const Samples* at, const Goal* goal, const float axis_x,
                          const float axis_y, const float huber, const int is_free, const int tilted, const int clamped,
                          Equations* sums) {
  float16 seen[kPaperPatchRows], along[kPaperPatchRows], across[kPaperPatchRows];
  float16 seen_sum = 0.0f, along_sum = 0.0f, across_sum = 0.0f;
  const float unit_x = axis_x * PER_SLOPE_UNIT, unit_y = axis_y * PER_SLOPE_UNIT;
  Places places;
  place_rows(picture, at, clamped, &places);
#pragma unroll
  for (int i = 0; i < kPaperPatchRows; ++i) {
    RowSamples row;
    read_row(picture, &places, i, &row);
    seen[i] = grey_of(&row);
    const float16 slope_x = INTERPOLATED(SLOPE_X_OF, &row);
    along[i] = slope_x * unit_x;
    if (tilted) {
      const float16 slope_y = INTERPOLATED(SLOPE_Y_OF, &row);
      along[i] += slope_y * unit_y;
      across[i] = slope_y * unit_x - slope_x * unit_y;
      across_sum += across[i];
    }
    seen_sum += seen[i];
    along_sum += along[i];
  }
  const float16 seen_mean = means_of_sides(seen_sum), along_mean = means_of_sides(along_sum),
                across_mean = means_of_sides(across_sum);
  float16 along2 = 0.0f, both = 0.0f, across2 = 0.0f, pull_along = 0.0f, pull_across = 0.0f, squares = 0.0f;
#pragma unroll
  for (int i = 0; i < kPaperPatchRows; ++i) {
    const float16 residual = goal->rows[i] - (seen[i] - seen_mean);
    const float16 weight = as_float16(as_int16(huber / max(fabs(residual), huber)) & goal->lanes);
    const float16 slope = along[i] - along_mean, weighted = weight * slope;
    along2 += weighted * slope;
    pull_along += weighted * residual;
    if (is_free) {
      const float16 other = across[i] - across_mean, other_weighted = weight * other;
      both += weighted * other;
      across2 += other_weighted * other;
      pull_across += other_weighted * residual;
      squares += weight * residual * residual;
    }
  }
  sums->along2 = sum_of(along2);
  sums->pull_along = sum_of(pull_along);
  if (is_free) {
    sums->both = sum_of(both);
    sums->across2 = sum_of(across2);
    sums->pull_across = sum_of(pull_across);
    sums->squares = sum_of(squares);
  }
}

// Moves the patches at (x, y) along the axis, or freely, until they look like the goal. No move is rejected.
INLINED void refine(const PaperRefinementArguments* args, const Picture picture, const Goal* goal, const float x,
                    const float y, const float cosine, const float sine, const float axis_x, const float axis_y,
                    const int is_free, Move* result) {
  Move move = {0.0f, 0.0f, 0.0f};
  for (int step = 0; step < args->steps; ++step) {
    Samples at;
    samples_beside(picture, x + move.x, y + move.y, cosine, sine, args->offset, &at);
    Equations sums;
    if (!at.inside)
      equations_at(picture, &at, goal, axis_x, axis_y, args->huber, is_free, 1, 1, &sums);
    else if (is_free || axis_y != 0.0f)
      equations_at(picture, &at, goal, axis_x, axis_y, args->huber, is_free, 1, 0, &sums);
    else
      equations_at(picture, &at, goal, axis_x, axis_y, args->huber, is_free, 0, 0, &sums);
    float along, across = 0.0f;
    if (is_free) {
      move.mean_square = sums.squares / goal->samples;
      const float damping = 1e-6f * goal->samples;
      sums.along2 += damping;
      sums.across2 += damping;
      const float determinant = sums.along2 * sums.across2 - sums.both * sums.both;
      if (!(determinant > 1e-8f)) break;
      along = (sums.across2 * sums.pull_along - sums.both * sums.pull_across) / determinant;
      across = (sums.along2 * sums.pull_across - sums.both * sums.pull_along) / determinant;
    } else {
      if (!(sums.along2 > 1e-8f)) break;
      along = sums.pull_along / sums.along2;
    }
    move.x += along * axis_x - across * axis_y;
    move.y += along * axis_y + across * axis_x;
    if (along * along + across * across < args->tolerance * args->tolerance) break;
  }
  *result = move;
}

// The sides that take part in the refinement of candidate c of row i.
static inline void find_pairing(const PaperRefinementArguments* args, global const float* fixed_patches,
                                global const float* moving_patches, const int i, const int target, Pairing* pairing) {
  if (args->both_sides) return;
  float16 a[kPaperPatchRows], b[kPaperPatchRows];
  const float2 norms_a = load_sides(fixed_patches, i, a), norms_b = load_sides(moving_patches, target, b);
  best_pairing(a, norms_a, b, norms_b, pairing);
}

// The alive candidates of a row. In stereo, patches have the left edge's direction in both images; the most similar
// pair may be of reversed contrast, for which the right one is turned. Of a free move, a candidate whose patches
// remain different stays where it is.
INLINED void refine_row(const PaperRefinementArguments* args, const int is_free, global const int* first,
                        global const int* target, global const uchar* state, global const uint* fixed_records,
                        global const uint* moving_records, global const float* fixed_edges,
                        global const float* moving_edges, global const float* fixed_patches,
                        global const float* moving_patches, global float* refined) {
  const int i = (int)get_global_id(0);
  if (i >= args->fixed.count) return;
  const int end = min(first[i + 1], args->capacity);
  int c = first[i];
  while (c < end && state[c] != kCandidateAlive) ++c;
  if (c >= end) return;
  const Picture fixed_picture = {fixed_records, args->fixed_width, args->fixed_height};
  const Picture picture = {moving_records, args->moving_width, args->moving_height};
  global const float* edge = fixed_edges + args->fixed.first + i;
  const float direction = edge[2 * args->fixed.stride];
  float cosine;
  float sine = sine_cosine(direction, &cosine);
  float16 fixed[kPaperPatchRows];
  cut_sides(fixed_picture, edge[0], edge[args->fixed.stride], cosine, sine, args->offset, fixed);
  EpipolarLine line;
  if (!is_free) line = epipolar_line(&args->geometry, edge[0], edge[args->fixed.stride]);
  for (; c < end; ++c) {
    if (state[c] != kCandidateAlive) continue;
    global const float* candidate = moving_edges + args->moving.first + target[c];
    const float candidate_direction = candidate[2 * args->moving.stride];
    float x = candidate[0], y = candidate[args->moving.stride], turn = 1.0f;
    if (is_free) {
      sine = sine_cosine(candidate_direction, &cosine);
    } else {
      const float s = position_on_line(&line, x, y, candidate_direction, args->shift_min_sine, args->shift_max);
      x = line.x + s * line.ex;
      y = line.y + s * line.ey;
      if (!args->both_sides && angle_between(direction, candidate_direction) > 0.5f * PI_F) turn = -1.0f;
    }
    Goal goal;
    Pairing pairing = {0, 0, 1.0f};
    find_pairing(args, fixed_patches, moving_patches, i, target[c], &pairing);
    prepare_goal(fixed, args->both_sides, pairing, &goal);
    Move move;
    refine(args, picture, &goal, x, y, turn * cosine, turn * sine, is_free ? -sine : line.ex,
           is_free ? cosine : line.ey, is_free, &move);
    const int kept = !is_free || move.mean_square <= args->largest_residual * args->largest_residual;
    refined[c] = kept ? x + move.x : x;
    refined[args->capacity + c] = kept ? y + move.y : y;
  }
}

#define DEFINE_KERNEL(NAME, IS_FREE)                                                                                  \
  kernel IN_VECTORS void NAME(const PaperRefinementArguments args, global const int* first, global const int* target, \
                              global const uchar* state, global const uint* fixed_records,                            \
                              global const uint* moving_records, global const float* fixed_edges,                     \
                              global const float* moving_edges, global const float* fixed_patches,                    \
                              global const float* moving_patches, global float* refined) {                            \
    refine_row(&args, IS_FREE, first, target, state, fixed_records, moving_records, fixed_edges, moving_edges,        \
               fixed_patches, moving_patches, refined);                                                               \
  }
DEFINE_KERNEL(paper_refine_stereo, 0)
DEFINE_KERNEL(paper_refine_free, 1)
