// candidate_positions.cl: positions of a left edge's candidates on its epipolar line, and which candidate is refined
// for all at one position.
// Functions only. Needs direction.cl and epipolar.cl.
// Reference: host/workbench/reference/stereo_matching.cpp.

// A left edge whose candidates are refined.
typedef struct {
  float x, y;          // px
  float cosine, sine;  // of its direction
  EpipolarLine line;
  float stiffness;  // of the refinement's prior, see align_edge()
} RefinedEdge;

static inline void open_edge(const StereoRefinementArguments* args, global const float* left_edges, const int i,
                             RefinedEdge* edge) {
  global const float* x = left_edges + args->left.first + i;
  const float direction = x[2 * args->left.stride];
  edge->x = x[0];
  edge->y = x[args->left.stride];
  edge->line = epipolar_line(&args->geometry, edge->x, edge->y);
  // The smaller the angle between edge and line, the less a position across the edge says about that along the line.
  const float line_sine = left_epipolar_sine(&args->geometry, edge->x, edge->y, direction);
  edge->stiffness = args->stiffness * line_sine * line_sine;
  edge->sine = sine_cosine(direction, &edge->cosine);
}

// Position s of the candidate after its shift onto the line.
static inline float epipolar_shift(const StereoRefinementArguments* args, const EpipolarLine* line,
                                   global const float* right_edges, const int candidate) {
  global const float* x = right_edges + args->right.first + candidate;
  return position_on_line(line, x[0], x[args->right.stride], x[2 * args->right.stride], args->shift_min_sine,
                          args->shift_max);
}

// Candidate c against the earlier ones of its row, which begins at `begin`: of candidates at one position the one whose
// sides are most similar stays alive and represents the others. To be called in the order of the row.
static inline void choose_representative(const int begin, const int c, global const float* ncc,
                                         global const float* position, global uchar* state) {
  for (int k = begin; k < c; ++k) {
    if (state[k] != kCandidateAlive || fabs(position[k] - position[c]) >= kSamePosition) continue;
    const int better = ncc[c] > ncc[k];
    state[better ? k : c] = kCandidateRepresented;
    if (!better) break;
  }
}

// After the refinement of a row: represented candidates stay where they are and take the similarity of the nearest
// alive one; where none is left they are rejected like it.
static inline void follow_representatives(const int begin, const int end, const int rejected_order,
                                          global const float* position, global uchar* state, global float* similarity) {
  for (int c = begin; c < end; ++c) {
    if (state[c] != kCandidateRepresented) continue;
    int nearest = -1;
    for (int k = begin; k < end; ++k) {
      if (state[k] == kCandidateAlive &&
          (nearest < 0 || fabs(position[k] - position[c]) < fabs(position[nearest] - position[c])))
        nearest = k;
    }
    if (nearest < 0)
      state[c] = (uchar)rejected_order;
    else
      similarity[c] = similarity[nearest];
  }
}
