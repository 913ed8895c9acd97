// paper_patches.cl: the picture that the paper's method samples, and both side patches of every edge.
//
// In: image (width x height, packed), edges (x, y [px], direction [rad]). Out: the records of paper_sides.cl;
// kPaperPatchFloats per edge, see layouts.cl.
// Needs direction.cl and paper_sides.cl.
// Reference: host/paper/side_patches.cpp.

// One work-item = one pixel: the record's words of the pixel itself, RECORD_PARTS of them.
kernel void paper_words(global const uchar* bytes, const int width, const int height, global uint* words) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= width || y >= height) return;
  global const Pixel* pixels = (global const Pixel*)bytes;
  const int left = max(x - 1, 0), right = min(x + 1, width - 1);
  global const Pixel* above = pixels + max(y - 1, 0) * width;
  global const Pixel* here = pixels + y * width;
  global const Pixel* below = pixels + min(y + 1, height - 1) * width;
  const int slope_x = (above[right] + 2 * here[right] + below[right]) - (above[left] + 2 * here[left] + below[left]);
  const int slope_y = (below[left] + 2 * below[x] + below[right]) - (above[left] + 2 * above[x] + above[right]);
  const uint grey = here[x];
#if MAX_VALUE > 255
  words[2 * (y * width + x)] = (grey & 4095u) | (uint)slope_x << 12u;
  words[2 * (y * width + x) + 1] = grey >> 12u | (uint)slope_y << 12u;
#else
  words[y * width + x] = grey | ((uint)slope_x & 4095u) << 8u | (uint)slope_y << 20u;
#endif
}

// One work-item = one pixel: its record.
kernel void paper_records(global const uint* words, const int width, const int height, global uint* records) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= width || y >= height) return;
  const int right = min(x + 1, width - 1), below = min(y + 1, height - 1) * width, here = y * width;
  for (int k = 0; k < RECORD_PARTS; ++k)
    ((global uint4*)records)[RECORD_PARTS * (here + x) + k] =
        (uint4)(words[RECORD_PARTS * (here + x) + k], words[RECORD_PARTS * (here + right) + k],
                words[RECORD_PARTS * (below + x) + k], words[RECORD_PARTS * (below + right) + k]);
}

// One work-item = one edge.
kernel IN_VECTORS void paper_patches(const PatchArguments args, global const uint* records,
                                     global const float* positions, global float* patches) {
  const int edge = (int)get_global_id(0);
  if (edge >= args.edges.count) return;
  global const float* x = positions + args.edges.first + edge;
  float cosine;
  const float sine = sine_cosine(x[2 * args.edges.stride], &cosine);
  const Picture picture = {(global const uint4*)records, args.width, args.height};
  float16 rows[kPaperPatchRows];
  cut_sides(picture, x[0], x[args.edges.stride], cosine, sine, args.offset, rows);
  global float* to = patches + (size_t)edge * kPaperPatchFloats;
  for (int i = 0; i < kPaperPatchRows; ++i) ((global float16*)to)[i] = rows[i];
  const float16 none = 0.0f;
  float16 last = none;
  last.s01 = inverse_norms(rows);
  ((global float16*)to)[kPaperPatchRows] = last;
}
