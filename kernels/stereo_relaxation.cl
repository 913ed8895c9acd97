// stereo_relaxation.cl: filter 10 of the stereo cascade: relaxation labelling. Neighbouring edges vote on the
// candidates of an edge.
//
// Needs direction.cl and epipolar.cl. One work-item = one left edge; its candidates are the clusters of
// stereo_clusters.cl that reach similarity_min, the others have prior 0. Beliefs of a round are read and those of the
// next one written, so the order of the work-items decides nothing. `slopes`: two blocks of `capacity` floats.
// Reference: host/workbench/reference/stereo_matching.cpp.

// How much a candidate's position on the epipolar line changes per px along the left edge, as the right direction
// tells: the next point of the left curve lies where its epipolar line meets the right curve. 0 where the right
// edge runs along the line.
static inline float position_slope(const EpipolarLine line, const EpipolarLine ahead, const float position,
                                   const float right_direction) {
  float cosine;
  const float sine = sine_cosine(right_direction, &cosine);
  const float across = ahead.ex * sine - ahead.ey * cosine;
  if (!ahead.valid || fabs(across) < kSlopeMinSine) return 0.0f;
  const float dx = line.x + position * line.ex - ahead.x, dy = line.y + position * line.ey - ahead.y;
  return clamp((dx * sine - dy * cosine) / across - position, -kSlopeMax, kSlopeMax);
}

// Before the first round: beliefs by similarity alone, slopes as vectors (change per px along x and y), and the first
// edge with a candidate in every cell of the image (INT_MAX: none).
kernel void relaxation_start(const StereoRelaxationArguments args, global const int* first,
                             global const int* cluster_count, global const float* left_edges,
                             global const float* clusters, global float* prior, global float* belief,
                             global float* next_belief, global float* slopes, global int* cells) {
  const int i = (int)get_global_id(0);
  if (i >= args.left.count) return;
  const int begin = first[i], end = begin + cluster_count[i];
  global const float* left = left_edges + args.left.first + i;
  global const float* position = clusters;
  global const float* direction = clusters + args.capacity;
  global const float* similarity = clusters + 2 * args.capacity;
  float highest = -1.0f;
  for (int k = begin; k < end; ++k) highest = fmax(highest, similarity[k]);
  float total = 0.0f;
  for (int k = begin; k < end; ++k) {
    prior[k] = similarity[k] < args.similarity_min ? 0.0f
               : similarity[k] == highest          ? 1.0f
                                                   : exp((similarity[k] - highest) / args.scale);
    total += prior[k];
  }
  for (int k = begin; k < end; ++k) belief[k] = next_belief[k] = total > 0.0f ? prior[k] / total : 0.0f;
  if (total <= 0.0f) return;
  const float x = left[0], y = left[args.left.stride];
  float cosine;
  const float sine = sine_cosine(left[2 * args.left.stride], &cosine);
  const EpipolarLine line = epipolar_line(&args.geometry, x, y);
  const EpipolarLine ahead = epipolar_line(&args.geometry, x + cosine, y + sine);
  for (int k = begin; k < end; ++k) {
    const float slope = position_slope(line, ahead, position[k], direction[k]);
    slopes[k] = slope * cosine;
    slopes[args.capacity + k] = slope * sine;
  }
  atomic_min(cells + (int)(y / kRelaxationCell) * args.columns + (int)(x / kRelaxationCell), i);
}

// The edge that represents point n of the rings around (x, y); INT_MAX: none.
static inline int neighbour_at(const StereoRelaxationArguments* args, global const int* cells, const float x,
                               const float y, const int n) {
  const float radius = kRelaxationRing[n / 8];
  const float at_x = x + radius * kEighthCosine[n & 7], at_y = y + radius * kEighthCosine[(n + 6) & 7];
  const int column = (int)(at_x / kRelaxationCell), row = (int)(at_y / kRelaxationCell);
  if (at_x < 0.0f || at_y < 0.0f || column >= args->columns || row >= args->cell_rows) return INT_MAX;
  return cells[row * args->columns + column];
}

// Support of a candidate by the candidates begin .. end of a neighbour at (dx, dy): the belief of the best-fitting one,
// reduced by its distance from the position that the mean of both slopes predicts.
static inline float vote(global const float* position, global const float* slope_x, global const float* slope_y,
                         global const float* belief, const int candidate, const int begin, const int end,
                         const float dx, const float dy, const float reach) {
  float most = 0.0f;
  for (int c = begin; c < end; ++c) {
    const float expected = 0.5f * ((slope_x[candidate] + slope_x[c]) * dx + (slope_y[candidate] + slope_y[c]) * dy);
    const float apart = (position[c] - position[candidate] - expected) / reach;
    most = fmax(most, belief[c] * (1.0f - apart * apart));
  }
  return most;
}

// Counts the edges with a candidate, and those of them that are undecided.
kernel void relaxation_tally(const StereoRelaxationArguments args, global const int* first,
                             global const int* cluster_count, global const float* belief, global int* tally) {
  const int i = (int)get_global_id(0);
  if (i >= args.left.count) return;
  float highest = 0.0f;
  for (int k = first[i]; k < first[i] + cluster_count[i]; ++k) highest = fmax(highest, belief[k]);
  if (highest <= 0.0f) return;
  atomic_inc(tally);
  if (highest < args.undecided) atomic_inc(tally + 1);
}

// Starts the vote again with a coarse disparity of the pair: where it agrees with a candidate of an edge, the other
// candidates become less likely. At a contour the pixels on both sides of the edge count, one for either surface.
kernel void relaxation_consult(const StereoRelaxationArguments args, global const int* first,
                               global const int* cluster_count, global const float* left_edges,
                               global const float* clusters, global const float* coarse, global float* prior,
                               global float* belief, global float* next_belief) {
  const int i = (int)get_global_id(0);
  if (i >= args.left.count) return;
  const int begin = first[i], end = begin + cluster_count[i];
  const int column = (int)(0.5f * left_edges[args.left.first + i]);
  const int row = (int)(0.5f * left_edges[args.left.first + args.left.stride + i]);
  const int from = max(column - 1, 0), to = min(column + 1, args.coarse_columns - 1);
  int speaks = 0;
  for (int k = begin; k < end; ++k) {
    int near = 0;
    for (int x = from; x <= to && row < args.coarse_rows; ++x)
      near |= fabs(clusters[k] - coarse[row * args.coarse_columns + x]) < args.coarse_reach;
    next_belief[k] = near ? prior[k] : args.coarse_dissent * prior[k];
    speaks |= near && prior[k] > 0.0f;
  }
  float total = 0.0f;
  for (int k = begin; k < end; ++k) {
    if (speaks) prior[k] = next_belief[k];
    total += prior[k];
  }
  for (int k = begin; k < end; ++k) belief[k] = next_belief[k] = total > 0.0f ? prior[k] / total : 0.0f;
}

// One round for the edges that have a choice: prior * (floor + mean of the neighbours' votes)^2, normalised.
kernel void relaxation_round(const StereoRelaxationArguments args, global const int* first,
                             global const int* cluster_count, global const float* left_edges,
                             global const float* clusters, global const float* slopes, global const int* cells,
                             global const float* prior, global const float* belief, global float* next_belief) {
  const int i = (int)get_global_id(0);
  if (i >= args.left.count) return;
  const int begin = first[i], end = begin + cluster_count[i];
  int candidates = 0;
  for (int k = begin; k < end; ++k) candidates += prior[k] > 0.0f;
  if (candidates < 2) return;
  global const float* left_x = left_edges + args.left.first;
  global const float* left_y = left_x + args.left.stride;
  const float x = left_x[i], y = left_y[i];
  for (int k = begin; k < end; ++k) next_belief[k] = 0.0f;
  int voters = 0;
  for (int n = 0; n < kRelaxationNeighbours; ++n) {
    const int j = neighbour_at(&args, cells, x, y, n);
    if (j == INT_MAX) continue;
    const float dx = left_x[j] - x, dy = left_y[j] - y;
    const int from = first[j], to = from + cluster_count[j];
    for (int k = begin; k < end; ++k) {
      if (prior[k] > 0.0f)
        next_belief[k] +=
            vote(clusters, slopes, slopes + args.capacity, belief, k, from, to, dx, dy, kSupportReach[n / 8]);
    }
    ++voters;
  }
  float total = 0.0f;
  for (int k = begin; k < end; ++k) {
    const float support = kSupportFloor + (voters > 0 ? next_belief[k] / (float)voters : 0.0f);
    next_belief[k] = prior[k] * support * support;
    total += next_belief[k];
  }
  for (int k = begin; k < end; ++k) next_belief[k] /= total;
}

// The candidate with the highest belief; among equal ones the most similar, then the first. Its score is its similarity
// plus the support of the neighbours; a single candidate that needs no support gets no vote. chosen = -1: no candidate,
// or its score is below score_min.
kernel void relaxation_choose(const StereoRelaxationArguments args, global const int* first,
                              global const int* cluster_count, global const float* left_edges,
                              global const float* clusters, global const float* slopes, global const int* cells,
                              global const float* belief, global int* chosen, global float* score) {
  const int i = (int)get_global_id(0);
  if (i >= args.left.count) return;
  global const float* similarity = clusters + 2 * args.capacity;
  const int begin = first[i], end = begin + cluster_count[i];
  int best = -1, candidates = 0;
  for (int k = begin; k < end; ++k) {
    if (belief[k] <= 0.0f) continue;
    ++candidates;
    if (best < 0 || belief[k] > belief[best] || (belief[k] == belief[best] && similarity[k] > similarity[best]))
      best = k;
  }
  chosen[i] = -1;
  score[i] = 0.0f;
  if (best < 0) return;
  float support = kUsualSupport;
  if (args.support_weight > 0.0f && (candidates > 1 || similarity[best] < args.score_min)) {
    global const float* left_x = left_edges + args.left.first;
    global const float* left_y = left_x + args.left.stride;
    const float x = left_x[i], y = left_y[i];
    int voters = 0;
    support = 0.0f;
    for (int n = 0; n < kRelaxationNeighbours; ++n) {
      const int j = neighbour_at(&args, cells, x, y, n);
      if (j == INT_MAX) continue;
      support += vote(clusters, slopes, slopes + args.capacity, belief, best, first[j], first[j] + cluster_count[j],
                      left_x[j] - x, left_y[j] - y, kSupportReach[n / 8]);
      ++voters;
    }
    if (voters > 0) support /= (float)voters;
  }
  score[i] = similarity[best] + args.support_weight * support;
  if (score[i] >= args.score_min) chosen[i] = best;
}
