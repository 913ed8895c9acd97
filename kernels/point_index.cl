// point_index.cl: a point index (host/common/point_index.hpp) as kernels read it. Functions only.
//
// cell_first: starts of the cells, rows of `columns` cells. The points' values stand in the order of the index.

#define CELL_WIDTH 8.0f
#define CELL_HEIGHT 4.0f

inline int cell_of(const float place, const float size, const int count) {
  return (int)clamp(place / size, 0.0f, (float)(count - 1));
}
