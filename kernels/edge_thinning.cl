// edge_thinning.cl: one edge per pixel along a curve; an optional pass over detected edges.
//
// An edge is kept unless the same pixel (nearest to its position) holds a stronger one whose direction is within 45
// degrees; of equals the first one is the stronger. Edges come packed in blocks of `stride` floats: x, y, direction,
// strength, scale drift.
// Reference: host/reference/edge_thinning.cpp.

// flags[i] = edge i is kept; counts[row] = kept edges of the row. One work-item per row of the doubled grid.
// Edges of one pixel lie in at most three neighbouring rows (kEdgeRowReach is half a pixel), and rows are short to
// search.
kernel void edges_thinning_flags(global const float* edges, const int stride, global const int* row_first,
                                 const int rows, global uchar* flags, global int* counts) {
  const int row = (int)get_global_id(0);
  if (row >= rows) return;
  global const float* x = edges;
  global const float* y = edges + stride;
  global const float* direction = edges + 2 * stride;
  global const float* strength = edges + 3 * stride;
  int kept = 0;
  for (int i = row_first[row]; i < row_first[row + 1]; ++i) {
    const int px = (int)floor(x[i] + 0.5f), py = (int)floor(y[i] + 0.5f);
    uchar keep = 1;
    for (int other = max(2 * py - 1, 0); other <= min(2 * py + 1, rows - 1); ++other) {
      // Binary search for the first edge that may round to px. Along a row the cells are sorted and x lies within half
      // a pixel of its cell, so that an edge of pixel px comes neither before x = px - 1.5 nor after x = px + 1.5 for
      // the first time.
      int low = row_first[other], high = row_first[other + 1];
      while (low < high) {
        const int middle = (low + high) / 2;
        if (x[middle] < (float)px - 1.5f) {
          low = middle + 1;
        } else {
          high = middle;
        }
      }
      for (int j = low; j < row_first[other + 1] && x[j] < (float)px + 1.5f; ++j) {
        if (j == i || (int)floor(x[j] + 0.5f) != px || (int)floor(y[j] + 0.5f) != py) continue;
        const bool stronger = strength[j] > strength[i] || (strength[j] == strength[i] && j < i);
        if (stronger && angle_between(direction[i], direction[j]) <= 0.25f * PI_F) keep = 0;
      }
    }
    flags[i] = keep;
    kept += keep;
  }
  counts[row] = kept;
}

// Moves the kept edges of a row to their position. One work-item per row.
kernel void edges_thinning_move(global const float* edges, const int stride, global const int* row_first,
                                const int rows, global const uchar* flags, global const int* new_row_first,
                                global float* thinned) {
  const int row = (int)get_global_id(0);
  if (row >= rows) return;
  int position = new_row_first[row];
  for (int i = row_first[row]; i < row_first[row + 1]; ++i) {
    if (!flags[i]) continue;
    for (int block = 0; block < 5; ++block) thinned[block * stride + position] = edges[block * stride + i];
    ++position;
  }
}
