// padded_plane.cl: an image as floats with its border replicated; needs edge_detection.cl, which describes the layout
// of the plane.

// One work-item = 16 neighbouring floats of the plane.
kernel void edges_pad(global const uchar* bytes, const int width, const int height, global float* plane,
                      const int stride) {
  const int x = 16 * (int)get_global_id(0) - PAD_X;
  const int row = (int)get_global_id(1);
  if (x + PAD_X >= stride || row >= height + 2 * PAD_Y) return;
  global const Pixel* source = (global const Pixel*)bytes + clamp(row - PAD_Y, 0, height - 1) * width;
  global float* target = plane + row * stride + x + PAD_X;
  if (x >= 0 && x + 16 <= width) {
    vstore16(convert_float16(vload16(0, source + x)) * GREY_PER_VALUE, 0, target);
  } else {
    for (int k = 0; k < 16; ++k) target[k] = (float)source[clamp(x + k, 0, width - 1)] * GREY_PER_VALUE;
  }
}
