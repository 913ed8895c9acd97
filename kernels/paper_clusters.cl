// paper_clusters.cl: clusters the refined candidates of every row, and compares the clusters in stereo with the left
// edge.
//
// Needs direction.cl and paper_sides.cl. In: candidate lists, refined positions (paper_refinement.cl), the scan of
// paper_alive_counts(). Out, for cluster k of row i at alive_first[i] + k: centre and direction; similarity in stereo;
// its first member, as an offset in `members`, and their number. `members` are the targets, those of a cluster one
// after the other, the nearest to the centre first.
// One work-item = one row.
// Reference: host/workbench/paper/cascades.cpp.

// The refined candidates of a row that are alive: member m is candidate order[m], and of the cluster that the number of
// one of its members identifies, cluster[m].
typedef struct {
  int count;
  global const int* order;
  global int* cluster;
  global const float* x;  // of all candidates
  global const float* y;
  global const int* target;
  global const float* direction;  // of all targets
} Members;

static inline float distance2_of(const Members* all, const int a, const int b) {
  const float dx = all->x[all->order[a]] - all->x[all->order[b]], dy = all->y[all->order[a]] - all->y[all->order[b]];
  return dx * dx + dy * dy;
}

static inline float direction_of(const Members* all, const int m) { return all->direction[all->target[all->order[m]]]; }

// The nearest member of another cluster that member i may join; -1 if there is none.
static inline int partner_of(const PaperClusterArguments* args, const Members* all, const int i) {
  int nearest = -1;
  float shortest = args->gap * args->gap;
  for (int j = 0; j < all->count; ++j) {
    const float distance = distance2_of(all, i, j);
    if (all->cluster[i] == all->cluster[j] || !(distance < shortest)) continue;
    if (angle_between(direction_of(all, i), direction_of(all, j)) >= args->orientation) continue;
    nearest = j;
    shortest = distance;
  }
  if (nearest < 0) return -1;
  int size = 0;
  for (int j = 0; j < all->count; ++j)
    size += all->cluster[j] == all->cluster[i] || all->cluster[j] == all->cluster[nearest];
  return size <= args->size_max ? nearest : -1;
}

// A cluster's centre: the centroid and the direction, weighted by a Gaussian of the distance from it. Relative to the
// first member, so that large coordinates lose no digits.
typedef struct {
  float x, y;
} Centre;

// In steps of kClusterDistanceStep: both members of a pair are equally far away, and rounding must not order them.
static inline float steps_of(const float distance) { return rint(distance / kClusterDistanceStep); }

static inline float distance_from(const Members* all, const Centre centre, const int candidate) {
  const float dx = all->x[candidate] - centre.x, dy = all->y[candidate] - centre.y;
  return sqrt(dx * dx + dy * dy);
}

// Appends the cluster of that number to `members`, as candidates sorted by the distance from the centre, those of equal
// distance in the order of the list; returns their number.
static inline int sort_members(const Members* all, const int number, global int* members, Centre* centre) {
  const float first_x = all->x[all->order[number]], first_y = all->y[all->order[number]];
  float sum_x = 0.0f, sum_y = 0.0f;
  int size = 0;
  for (int m = 0; m < all->count; ++m) {
    if (all->cluster[m] != number) continue;
    const int candidate = all->order[m];
    sum_x += all->x[candidate] - first_x;
    sum_y += all->y[candidate] - first_y;
    members[size++] = candidate;
  }
  centre->x = first_x + sum_x / (float)size;
  centre->y = first_y + sum_y / (float)size;
  for (int k = 1; k < size; ++k) {
    const int candidate = members[k];
    const float steps = steps_of(distance_from(all, *centre, candidate));
    int at = k;
    for (; at > 0 && steps_of(distance_from(all, *centre, members[at - 1])) > steps; --at)
      members[at] = members[at - 1];
    members[at] = candidate;
  }
  return size;
}

static inline float mean_direction(const Members* all, global const int* members, const int size, const Centre centre,
                                   const float sigma) {
  float cosines = 0.0f, sines = 0.0f;
  for (int k = 0; k < size; ++k) {
    const float away = distance_from(all, centre, members[k]) / sigma, weight = exp(-0.5f * away * away);
    float cosine;
    const float sine = sine_cosine(all->direction[all->target[members[k]]], &cosine);
    cosines += weight * cosine;
    sines += weight * sine;
  }
  return atan2(sines, cosines);
}

// Agglomeration with single linkage. After a join no earlier member can have gained a partner: clusters only grow, and
// its nearest one is either the same or was too large to join. So the search goes on where it is. `scratch`: two blocks
// of `capacity`.
kernel void paper_clusters(const PaperClusterArguments args, global const int* first, global const int* target,
                           global const uchar* state, global const int* alive_first, global const float* moving_edges,
                           global const float* refined, global int* scratch, global int* count, global float* clusters,
                           global int* member_first, global int* members) {
  const int i = (int)get_global_id(0);
  if (i >= args.rows) return;
  const int begin = first[i], end = min(first[i + 1], args.candidates), home = alive_first[i];
  global int* order = scratch + home;
  Members all = {0,
                 order,
                 scratch + args.capacity + home,
                 refined,
                 refined + args.candidates,
                 target,
                 moving_edges + args.moving.first + 2 * args.moving.stride};
  for (int c = begin; c < end; ++c) {
    if (state[c] != kCandidateAlive) continue;
    order[all.count] = c;
    all.cluster[all.count] = all.count;
    ++all.count;
  }
  for (int m = 0; m < all.count;) {
    const int joined = partner_of(&args, &all, m);
    if (joined < 0) {
      ++m;
      continue;
    }
    const int gone = all.cluster[joined], number = all.cluster[m];
    for (int j = 0; j < all.count; ++j)
      if (all.cluster[j] == gone) all.cluster[j] = number;
  }
  int found = 0, at = home;
  for (int number = 0; number < all.count; ++number) {
    if (all.cluster[number] != number) continue;  // the member that gives a cluster its number stays in it
    Centre centre;
    const int size = sort_members(&all, number, members + at, &centre), k = home + found++;
    clusters[k] = centre.x;
    clusters[args.capacity + k] = centre.y;
    clusters[2 * args.capacity + k] = mean_direction(&all, members + at, size, centre, args.sigma);
    member_first[k] = at;
    member_first[args.capacity + k] = size;
    for (int m = 0; m < size; ++m) members[at + m] = target[members[at + m]];
    at += size;
  }
  count[i] = found;
}

// Candidates of a row that are alive: at least as many as its clusters.
kernel void paper_alive_counts(const int rows, const int candidates, global const int* first, global const uchar* state,
                               global int* counts) {
  const int i = (int)get_global_id(0);
  if (i >= rows) return;
  int alive = 0;
  for (int c = first[i]; c < min(first[i + 1], candidates); ++c) alive += state[c] == kCandidateAlive;
  counts[i] = alive;
}

// NCC of the clusters of a row with its left edge, and the most similar one, the first of equals; -1: none has ncc_min.
kernel IN_VECTORS void paper_similarity(const PaperSimilarityArguments args, global const int* alive_first,
                                        global const int* count, global const uint* records,
                                        global const float* patches, global float* clusters, global int* chosen) {
  const int i = (int)get_global_id(0);
  if (i >= args.rows) return;
  const int begin = alive_first[i], end = begin + count[i];
  int best = -1;
  if (begin < end) {
    const Picture picture = {records, args.width, args.height};
    float16 left[kPaperPatchRows], right[kPaperPatchRows];
    const float2 left_norms = load_sides(patches, i, left);
    float highest = args.ncc_min;
    for (int k = begin; k < end; ++k) {
      float cosine;
      const float sine = sine_cosine(clusters[2 * args.capacity + k], &cosine);
      cut_sides(picture, clusters[k], clusters[args.capacity + k], cosine, sine, args.offset, right);
      Pairing pairing;
      best_pairing(left, left_norms, right, inverse_norms(right), &pairing);
      const float ncc = pairing.ncc;
      clusters[3 * args.capacity + k] = ncc;
      if (!(ncc >= highest) || (best >= 0 && ncc == highest)) continue;
      best = k - begin;
      highest = ncc;
    }
  }
  chosen[i] = best;
}
