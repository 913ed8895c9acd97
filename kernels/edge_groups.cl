// edge_groups.cl: groups of edges that chain up by position and direction: single linkage. Functions only. Needs
// edge_positions.cl.

// Whether edges i and j are neighbours in a group.
static inline int are_chained(const PackedPositions at, global const float* packed, const int i, const int j,
                              const QuadChoice* choice) {
  const float3 a = edge_at(at, packed, i), b = edge_at(at, packed, j);
  const float dx = a.x - b.x, dy = a.y - b.y;
  return dx * dx + dy * dy < choice->cluster_gap * choice->cluster_gap &&
         angle_between(a.z, b.z) <= choice->cluster_orientation;
}

// Number of groups among edges[begin .. end - 1]. On entry label[c] is c where edge c takes part, negative where it
// does not; on return it is the first member of the edge's group. A macro, since OpenCL C 1.2 has no pointers to any
// address space: lists are in private or in global memory.
#define DEFINE_COUNT_GROUPS(NAME, SPACE)                                                                   \
  static inline int NAME(const int begin, const int end, SPACE const int* edges, const PackedPositions at, \
                         global const float* packed, const QuadChoice* choice, SPACE int* label) {         \
    for (int changed = 1; changed;) {                                                                      \
      changed = 0;                                                                                         \
      for (int c = begin; c < end; ++c) {                                                                  \
        for (int d = begin; d < c && label[c] >= 0; ++d) {                                                 \
          if (label[d] < 0 || label[d] == label[c]) continue;                                              \
          if (!are_chained(at, packed, edges[c], edges[d], choice)) continue;                              \
          label[c] = label[d] = min(label[c], label[d]);                                                   \
          changed = 1;                                                                                     \
        }                                                                                                  \
      }                                                                                                    \
    }                                                                                                      \
    int groups = 0;                                                                                        \
    for (int c = begin; c < end; ++c) groups += label[c] == c;                                             \
    return groups;                                                                                         \
  }
