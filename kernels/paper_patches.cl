// paper_patches.cl: the picture that the paper's method samples, and both side patches of every edge.
//
// In: image (width x height, packed), edges (x, y [px], direction [rad]). Out: the records of paper_sides.cl, height x
// (width + 1); kPaperPatchFloats per edge, see layouts.cl.
// Needs direction.cl and paper_sides.cl.
// Reference: host/workbench/paper/side_patches.cpp.

// One work-item = one pixel: its word, in its own record and in that of the pixel above.
kernel void paper_picture(global const uchar* bytes, const int width, const int height, global uint* records) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x > width || y >= height) return;
  global const Pixel* pixels = (global const Pixel*)bytes;
  const int middle = min(x, width - 1), left = max(middle - 1, 0), right = min(x + 1, width - 1);
  global const Pixel* above = pixels + max(y - 1, 0) * width;
  global const Pixel* here = pixels + y * width;
  global const Pixel* below = pixels + min(y + 1, height - 1) * width;
  const int slope_x = (above[right] + 2 * here[right] + below[right]) - (above[left] + 2 * here[left] + below[left]);
  const int slope_y =
      (below[left] + 2 * below[middle] + below[right]) - (above[left] + 2 * above[middle] + above[right]);
  const uint grey = here[middle];
#if MAX_VALUE > 255
  const uint2 word = (uint2)((grey & 4095u) | (uint)slope_x << 12u, grey >> 12u | (uint)slope_y << 12u);
  global uint2* record = (global uint2*)records + 2 * (y * (width + 1) + x);
#else
  const uint word = grey | ((uint)slope_x & 4095u) << 8u | (uint)slope_y << 20u;
  global uint* record = records + 2 * (y * (width + 1) + x);
#endif
  record[0] = word;
  if (y > 0) record[1 - 2 * (width + 1)] = word;
  if (y == height - 1) record[1] = word;
}

// One work-item = one edge.
kernel IN_VECTORS void paper_patches(const PatchArguments args, global const uint* records,
                                     global const float* positions, global float* patches) {
  const int edge = (int)get_global_id(0);
  if (edge >= args.edges.count) return;
  global const float* x = positions + args.edges.first + edge;
  float cosine;
  const float sine = sine_cosine(x[2 * args.edges.stride], &cosine);
  const Picture picture = {records, args.width, args.height};
  float16 rows[kPaperPatchRows];
  cut_sides(picture, x[0], x[args.edges.stride], cosine, sine, args.offset, rows);
  global float* to = patches + (size_t)edge * kPaperPatchFloats;
  for (int i = 0; i < kPaperPatchRows; ++i) ((global float16*)to)[i] = rows[i];
  const float16 none = 0.0f;
  float16 last = none;
  last.s01 = inverse_norms(rows);
  ((global float16*)to)[kPaperPatchRows] = last;
}
