// coarse_planes.cl: what coarse_disparity.cl and coarse_disparity_groups.cl share: what they compare of both images,
// and the position of a level.
//
// coarse_halve   image -> grey levels of 2 x 2 pixels
// coarse_planes  these -> the planes of a row, one after the other: slope along the row, the bounds of the slope
//                half-way to either neighbour, and half the grey level with its bounds
//
// One group = one row, whatever the size of the group. Reference: host/workbench/reference/coarse_disparity.cpp.

kernel void coarse_halve(global const uchar* bytes, const int width, const int half_width, global uchar* half_image) {
  const int y = (int)get_group_id(0);
  global const Pixel* above = (global const Pixel*)bytes + 2 * y * width;
  global const Pixel* below = above + width;
  for (int x = (int)get_local_id(0); x < half_width; x += (int)get_local_size(0)) {
    const int sum = (int)above[2 * x] + (int)above[2 * x + 1] + (int)below[2 * x] + (int)below[2 * x + 1];
    half_image[y * half_width + x] = (uchar)((sum * 255 + 2 * MAX_VALUE) / (4 * MAX_VALUE));
  }
}

// Slope at column x, from 0 to 2 kCoarseSlope; the border is replicated.
static inline int slope_at(global const uchar* above, global const uchar* here, global const uchar* below,
                           const int width, const int x) {
  const int left = max(x - 1, 0), right = min(x + 1, width - 1);
  const int slope = (int)above[right] - (int)above[left] + 2 * ((int)here[right] - (int)here[left]) +
                    (int)below[right] - (int)below[left];
  return clamp(slope / 2, -kCoarseSlope, kCoarseSlope) + kCoarseSlope;
}

static inline void write_bounds(global uchar* out, const int stride, const int left, const int here, const int right) {
  out[0] = (uchar)here;
  out[stride] = (uchar)min(here, min((here + left) / 2, (here + right) / 2));
  out[2 * stride] = (uchar)max(here, max((here + left) / 2, (here + right) / 2));
}

// Column x stands at place front + x or, mirrored, front + width - 1 - x; the border fills the rest of the `stride`.
kernel void coarse_planes(global const uchar* half_image, const int width, const int height, const int front,
                          const int stride, const int mirrored, global uchar* planes) {
  const int y = (int)get_group_id(0);
  global const uchar* here = half_image + y * width;
  global const uchar* above = half_image + max(y - 1, 0) * width;
  global const uchar* below = half_image + min(y + 1, height - 1) * width;
  for (int place = (int)get_local_id(0); place < stride; place += (int)get_local_size(0)) {
    const int column = clamp(place - front, 0, width - 1), x = mirrored ? width - 1 - column : column;
    const int left = max(x - 1, 0), right = min(x + 1, width - 1);
    global uchar* out = planes + y * kCoarsePlanes * stride + place;
    write_bounds(out, stride, slope_at(above, here, below, width, left), slope_at(above, here, below, width, x),
                 slope_at(above, here, below, width, right));
    write_bounds(out + 3 * stride, stride, here[left] / 2, here[x] / 2, here[right] / 2);
  }
}

// Position on the epipolar line of a left pixel in column x with these sums, whose lowest is `best`; `back`: the lowest
// level of the right pixel that it points to.
static inline float coarse_position(const CoarseDisparityArguments* args, global const ushort* sums, const int x,
                                    const int best, const int back) {
  const int at = x + args->shift - best;
  if (at < 0 || at >= args->right_width || best == 0 || best == args->levels - 1 || abs(best - back) > 1)
    return kNoCoarseDisparity;
  const int below = sums[best - 1] - sums[best], above = sums[best + 1] - sums[best];
  const float part = below + above > 0 ? (float)(below - above) / (float)(2 * max(below, above)) : 0.0f;
  return args->first + 2.0f * ((float)best + part);
}
