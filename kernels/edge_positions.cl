// edge_positions.cl: packed positions of edges (layouts.cl), edge by edge. Functions only.

// Position and direction of edge i: x, y [px], direction [rad].
static inline float3 edge_at(const PackedPositions at, global const float* packed, const int i) {
  global const float* x = packed + at.first + i;
  return (float3)(x[0], x[at.stride], x[2 * at.stride]);
}
