// point_index.cl: the stereo edges of both sides sorted by cells of the image, cells in rows, and within a cell by
// number.
//
// Needs indexed_points.cl. In: packed edges of both sides. Out per side: `cells`, the first edge of every cell and the
// end of the last one, then the number of every edge in the order of the index; `points`, positions and directions in
// that order. One work-group of GROUP work-items = one side; its phases are a counting sort.
// Reference: host/reference/point_index.cpp.
#ifndef GROUP
#define GROUP 1
#endif

static inline int cell_at(const PackedPointIndex at, const float x, const float y) {
  return cell_of(y, kCellHeight, at.rows) * at.columns + cell_of(x, kCellWidth, at.columns);
}

#if GROUP > 1
#define COUNT(counter) atomic_inc(counter)
#define TAKE_BACK(counter) (atomic_dec(counter) - 1)
#define WAIT_FOR_GROUP() barrier(CLK_GLOBAL_MEM_FENCE | CLK_LOCAL_MEM_FENCE)

// Counts per cell become the ends of the cells. Every work-item owns one contiguous part of them.
static inline void sum_counts(global int* cells, const int count, local int* sums) {
  const int item = (int)get_local_id(0), part = (count + GROUP - 1) / GROUP;
  const int begin = min(item * part, count), end = min(begin + part, count);
  int sum = 0;
  for (int c = begin; c < end; ++c) sum += cells[c];
  sums[item] = sum;
  WAIT_FOR_GROUP();
  int before = 0;
  for (int other = 0; other < item; ++other) before += sums[other];
  for (int c = begin; c < end; ++c) {
    before += cells[c];
    cells[c] = before;
  }
}

// The work-items fill a cell in any order: its few numbers are put in theirs.
static inline void sort_numbers(global int* numbers, const int begin, const int end) {
  for (int k = begin + 1; k < end; ++k) {
    const int number = numbers[k];
    int to = k;
    for (; to > begin && numbers[to - 1] > number; --to) numbers[to] = numbers[to - 1];
    numbers[to] = number;
  }
}
#else
#define COUNT(counter) ++*(counter)
#define TAKE_BACK(counter) (--*(counter))
#define WAIT_FOR_GROUP()

static inline void sum_counts(global int* cells, const int count) {
  int before = 0;
  for (int c = 0; c < count; ++c) {
    before += cells[c];
    cells[c] = before;
  }
}
#endif

kernel void point_index(const PointIndexArguments args, global const float* left_edges, global const float* right_edges,
                        global float* left_points, global int* left_cells, global float* right_points,
                        global int* right_cells) {
  const int item = (int)get_local_id(0), side = (int)get_group_id(0);
  const PackedPositions edges = side == 0 ? args.left_edges : args.right_edges;
  const PackedPointIndex at = side == 0 ? args.left : args.right;
  global const float* x = (side == 0 ? left_edges : right_edges) + edges.first;
  global const float *y = x + edges.stride, *direction = y + edges.stride;
  global float* points = (side == 0 ? left_points : right_points) + at.points.first;
  global int* cells = side == 0 ? left_cells : right_cells;
  const int count = edges.count, cell_count = at.columns * at.rows;
  global int* numbers = cells + cell_count + 1;

  for (int c = item; c < cell_count; c += GROUP) cells[c] = 0;
  WAIT_FOR_GROUP();
  for (int i = item; i < count; i += GROUP) COUNT(cells + cell_at(at, x[i], y[i]));
  WAIT_FOR_GROUP();
#if GROUP > 1
  local int sums[GROUP];
  sum_counts(cells, cell_count, sums);
#else
  sum_counts(cells, cell_count);
#endif
  WAIT_FOR_GROUP();
  // From the last edge to the first, so that every cell's end comes down to its start.
  for (int i = count - 1 - item; i >= 0; i -= GROUP) numbers[TAKE_BACK(cells + cell_at(at, x[i], y[i]))] = i;
  if (item == 0) cells[cell_count] = count;
  WAIT_FOR_GROUP();
#if GROUP > 1
  for (int c = item; c < cell_count; c += GROUP) sort_numbers(numbers, cells[c], cells[c + 1]);
  WAIT_FOR_GROUP();
#endif
  for (int k = item; k < count; k += GROUP) {
    const int i = numbers[k];
    points[k] = x[i];
    points[at.points.stride + k] = y[i];
    points[2 * at.points.stride + k] = direction[i];
  }
}
