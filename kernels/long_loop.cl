// long_loop.cl: a loop longer than those of the stages. OpenCL sets no limit, but some drivers silently terminate loops
// (Mesa's llvmpipe after 65,535 iterations of all loops of a kernel), so that edges are missing in large images only.
// Part of the self-test; stage: host/tracker/device/stage.cpp.
//
// Out: the state of a linear congruential generator, which compilers do not evaluate in advance. One work-item.

kernel void long_loop(const int rounds, global uint* result) {
  uint value = 1u;
  for (int i = 0; i < rounds; ++i) value = 1664525u * value + 1013904223u;
  if (get_global_id(0) == 0) result[0] = value;
}
