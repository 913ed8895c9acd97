// point_index.cl: the stereo edges of both sides sorted by cells of the image, cells in rows, and within a cell by
// number.
//
// Needs indexed_points.cl. In: packed edges of both sides. Out per side: `cells`, the first edge of every cell and the
// end of the last one, then the number of every edge in the order of the index; `points`, positions and directions in
// that order. One work-item = one side; its phases are a counting sort. point_index_groups.cl is the same for GPUs.
// Reference: host/workbench/reference/temporal_matching.cpp.

kernel void point_index(const PointIndexArguments args, global const float* left_edges, global const float* right_edges,
                        global float* left_points, global int* left_cells, global float* right_points,
                        global int* right_cells) {
  const int side = (int)get_global_id(0);
  const PackedPositions edges = side == 0 ? args.left_edges : args.right_edges;
  const PackedPointIndex at = side == 0 ? args.left : args.right;
  global const float* x = (side == 0 ? left_edges : right_edges) + edges.first;
  global const float *y = x + edges.stride, *direction = y + edges.stride;
  global float* points = (side == 0 ? left_points : right_points) + at.points.first;
  global int* cells = side == 0 ? left_cells : right_cells;
  const int count = edges.count, cell_count = at.columns * at.rows;
  global int* numbers = cells + cell_count + 1;

  for (int c = 0; c < cell_count; ++c) cells[c] = 0;
  for (int i = 0; i < count; ++i) ++cells[cell_at(at, x[i], y[i])];
  int before = 0;
  for (int c = 0; c < cell_count; ++c) {
    before += cells[c];
    cells[c] = before;
  }
  // From the last edge to the first, so that every cell's end comes down to its start.
  for (int i = count - 1; i >= 0; --i) numbers[--cells[cell_at(at, x[i], y[i])]] = i;
  cells[cell_count] = count;
  for (int k = 0; k < count; ++k) {
    const int i = numbers[k];
    points[k] = x[i];
    points[at.points.stride + k] = y[i];
    points[2 * at.points.stride + k] = direction[i];
  }
}
