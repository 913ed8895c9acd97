// point_index_groups.cl: point_index.cl for GPUs, a counting sort in four launches: point_index_count, scan,
// point_index_place, point_index_sort.
//
// Needs indexed_points.cl. In and out as in point_index.cl, and the same bytes: edges enter a cell in any order, and
// then every cell is sorted. Cells and edges of both sides are numbered through, those of the left side first. One
// work-item = one edge or, in point_index_sort, one cell.
// Reference: host/workbench/reference/temporal_matching.cpp.

// An edge by its number among those of both sides.
typedef struct {
  int side, number;  // number: within its side
  int cell;          // among those of both sides
  int valid;
} NumberedEdge;

static inline NumberedEdge numbered_edge(const PointIndexArguments* args, global const float* left_edges,
                                         global const float* right_edges) {
  const int k = (int)get_global_id(0);
  NumberedEdge edge;
  edge.side = k >= args->left_edges.count;
  edge.number = edge.side ? k - args->left_edges.count : k;
  edge.valid = !edge.side || edge.number < args->right_edges.count;
  edge.cell = 0;
  if (!edge.valid) return edge;
  const PackedPositions edges = edge.side ? args->right_edges : args->left_edges;
  global const float* x = (edge.side ? right_edges : left_edges) + edges.first + edge.number;
  const int cell = cell_at(edge.side ? args->right : args->left, x[0], x[edges.stride]);
  edge.cell = edge.side ? args->left.columns * args->left.rows + cell : cell;
  return edge;
}

// counts[cell] = edges of the cell; zero before.
kernel void point_index_count(const PointIndexArguments args, global const float* left_edges,
                              global const float* right_edges, global int* counts) {
  const NumberedEdge edge = numbered_edge(&args, left_edges, right_edges);
  if (edge.valid) atomic_inc(counts + edge.cell);
}

// numbers: the edges of every cell from first[cell] on, in any order; `counts` is zero afterwards.
kernel void point_index_place(const PointIndexArguments args, global const float* left_edges,
                              global const float* right_edges, global const int* first, global int* counts,
                              global int* numbers) {
  const NumberedEdge edge = numbered_edge(&args, left_edges, right_edges);
  if (edge.valid) numbers[first[edge.cell] + atomic_dec(counts + edge.cell) - 1] = edge.number;
}

// Sorts the edges of a cell and writes the index.
kernel void point_index_sort(const PointIndexArguments args, global const float* left_edges,
                             global const float* right_edges, global const int* first, global int* numbers,
                             global float* left_points, global int* left_cells, global float* right_points,
                             global int* right_cells) {
  const int left_count = args.left.columns * args.left.rows, c = (int)get_global_id(0);
  if (c >= left_count + args.right.columns * args.right.rows) return;
  const int side = c >= left_count, cell = side ? c - left_count : c;
  const PackedPositions edges = side ? args.right_edges : args.left_edges;
  const PackedPointIndex at = side ? args.right : args.left;
  const int cell_count = at.columns * at.rows, before = side ? args.left_edges.count : 0;
  const int begin = first[c], end = first[c + 1];
  for (int k = begin + 1; k < end; ++k) {
    const int number = numbers[k];
    int to = k;
    for (; to > begin && numbers[to - 1] > number; --to) numbers[to] = numbers[to - 1];
    numbers[to] = number;
  }
  global int* cells = side ? right_cells : left_cells;
  cells[cell] = begin - before;
  if (cell == cell_count - 1) cells[cell_count] = end - before;
  global const float* x = (side ? right_edges : left_edges) + edges.first;
  global float* points = (side ? right_points : left_points) + at.points.first;
  for (int k = begin; k < end; ++k) {
    const int i = numbers[k], to = k - before;
    cells[cell_count + 1 + to] = i;
    points[to] = x[i];
    points[at.points.stride + to] = x[edges.stride + i];
    points[2 * at.points.stride + to] = x[2 * edges.stride + i];
  }
}
