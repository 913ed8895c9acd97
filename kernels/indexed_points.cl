// indexed_points.cl: a point index (point_index.cl) as kernels read it. Functions only.

typedef struct {
  global const float *x, *y, *direction;  // of the points, in the order of the index
  global const int* number;               // of the points
  global const int* cell_first;           // starts of the cells, rows of `columns` cells
  int columns, rows;
} PointIndex;

// The index at `at`; `points` and `cells` are the buffers of host/tracker/device/temporal_matching.hpp.
static inline PointIndex open_index(const PackedPointIndex at, global const float* points, global const int* cells) {
  PointIndex index;
  index.x = points + at.points.first;
  index.y = index.x + at.points.stride;
  index.direction = index.y + at.points.stride;
  index.cell_first = cells;
  index.number = cells + at.columns * at.rows + 1;
  index.columns = at.columns;
  index.rows = at.rows;
  return index;
}

static inline int cell_of(const float position, const float size, const int count) {
  return (int)clamp(position / size, 0.0f, (float)(count - 1));
}

// Number of the cell that a position belongs to.
static inline int cell_at(const PackedPointIndex at, const float x, const float y) {
  return cell_of(y, kCellHeight, at.rows) * at.columns + cell_of(x, kCellWidth, at.columns);
}
