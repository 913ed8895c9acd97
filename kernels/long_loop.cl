// long_loop.cl: a loop longer than those of the stages. OpenCL sets no limit, but there are drivers that end a kernel's
// loops without a word (Mesa's llvmpipe after 65,535 rounds of all of them together), so that large images lack edges
// which small ones have. Part of the self-test; stage: host/stages/long_loop.cpp.
//
// Out: what a linear congruential generator has reached, which no compiler works out beforehand. One work-item.

kernel void long_loop(const int rounds, global uint* result) {
  uint value = 1u;
  for (int i = 0; i < rounds; ++i) value = 1664525u * value + 1013904223u;
  if (get_global_id(0) == 0) result[0] = value;
}
