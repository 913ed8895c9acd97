// ceilings.cl: peak bandwidth and arithmetic of the device, to compare kernel times with (host/benchmark/ceilings.hpp).
//
// ceiling_copy   In: `count` vectors of 16 floats. Out: the same elsewhere. Each work-item takes its part of
//                neighbouring vectors where CHUNK is above 1 (CPUs), or every get_global_size(0)-th one (GPUs), so that
//                loads are contiguous for both.
// ceiling_fma    Out: one sum per work-item, of ROUNDS * 8 * 16 fused multiply-adds in eight chains of float16, which
//                are independent and stay in registers once the loops over them are unrolled.

#ifndef CHUNK
#define CHUNK 1
#endif
#define ROUNDS 1024

kernel void ceiling_copy(global const float* source, const int count, global float* target) {
  const int item = (int)get_global_id(0), items = (int)get_global_size(0);
#if CHUNK > 1
  const int each = (count + items - 1) / items, begin = item * each, end = min(count, begin + each), step = 1;
#else
  const int begin = item, end = count, step = items;
#endif
  for (int i = begin; i < end; i += step) vstore16(vload16((size_t)i, source), (size_t)i, target);
}

kernel void ceiling_fma(const float factor, global float* sums) {
  float16 chain[8];
  _Pragma("unroll") for (int k = 0; k < 8; ++k) chain[k] = (float16)((float)(k + (int)get_global_id(0)));
  for (int round = 0; round < ROUNDS; ++round) {
    _Pragma("unroll") for (int k = 0; k < 8; ++k) chain[k] = fma(chain[k], (float16)(factor), (float16)(0.5f));
  }
  float16 sum = 0.0f;
  _Pragma("unroll") for (int k = 0; k < 8; ++k) sum += chain[k];
  const float8 eight = sum.lo + sum.hi;
  const float4 four = eight.lo + eight.hi;
  sums[get_global_id(0)] = (four.x + four.y) + (four.z + four.w);
}
