// candidate_places.cl: places of a left edge's candidates on its epipolar line, and which candidate is refined for all at one place.
// Functions only. Needs direction.cl and epipolar.cl.
// Reference: host/reference/stereo_refinement.cpp.

// Candidates that shift onto the line within so many px of one another are one: neighbours on a curve, which the refinement leads to the
// same place. Twin: kSamePlace in host/reference/stereo_refinement.cpp.
#define SAME_PLACE 0.5f
#define STOOD_FOR 255  // in rejected_by, for a while: another candidate is refined for this one

// Moves the candidate onto the line: along its tangent where that is well defined, else orthogonally. Returns its place s.
inline float epipolar_shift(const EpipolarLine line, const float x, const float y, const float direction,
                            const float min_sine, const float max_shift) {
  const float dx = x - line.x, dy = y - line.y;
  const float s = dx * line.ex + dy * line.ey;
  const float distance = -dx * line.ey + dy * line.ex;
  float cosine;
  const float sine = sine_cosine(direction, &cosine);
  const float across = -cosine * line.ey + sine * line.ex;  // sine of the angle between line and tangent
  const float along = cosine * line.ex + sine * line.ey;
  if (fabs(across) <= min_sine) return s;
  const float shift = -distance / across;
  return fabs(shift) < max_shift ? s + shift * along : s;
}

// Candidate c against the earlier ones of its row, which begins at `begin`: of candidates at one place the one whose sides are most
// alike stays, the others become STOOD_FOR. To be called in the order of the row.
inline void settle_place(const int begin, const int c, global const float* ncc, global const float* place,
                         global uchar* rejected_by) {
  for (int k = begin; k < c; ++k) {
    if (rejected_by[k] != 0 || fabs(place[k] - place[c]) >= SAME_PLACE) continue;
    const int better = ncc[c] > ncc[k];
    rejected_by[better ? k : c] = STOOD_FOR;
    if (!better) break;
  }
}

// After the refinement of a row: those stood for stay where they are and join their neighbour's cluster, where they count for its
// direction and cannot represent it.
inline void join_neighbours(const int begin, const int end, const int rejected_order, global const float* place,
                            global uchar* rejected_by, global float* likeness) {
  for (int c = begin; c < end; ++c) {
    if (rejected_by[c] != STOOD_FOR) continue;
    int nearest = -1;
    for (int k = begin; k < end; ++k) {
      if (rejected_by[k] == 0 && likeness[k] >= -1.0f &&
          (nearest < 0 || fabs(place[k] - place[c]) < fabs(place[nearest] - place[c])))
        nearest = k;
    }
    rejected_by[c] = nearest < 0 ? (uchar)rejected_order : 0;
    if (nearest < 0) continue;
    likeness[c] = likeness[nearest] - 3.0f;
  }
}
