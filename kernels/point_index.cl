// point_index.cl: a point index (host/common/point_index.hpp) as kernels read it. Functions only.
//
// cell_first: starts of the cells, rows of `columns` cells. The points' values stand in the order of the index.

inline int cell_of(const float position, const float size, const int count) {
  return (int)clamp(position / size, 0.0f, (float)(count - 1));
}
