#include "stages/long_loop.hpp"

#include "opencl/kernel.hpp"

namespace quadedge::stages {

std::string long_loop_difference(opencl::Context& context, cl_int rounds) {
  const opencl::Kernel<cl_int, opencl::Out<cl_uint>> kernel(context, context.program({"long_loop.cl"}, {}),
                                                            "long_loop");
  opencl::Buffer<cl_uint> result(context, 1);
  kernel({1, 1}, rounds, result);
  cl_uint expected = 1;
  for (cl_int i = 0; i < rounds; ++i) expected = 1664525U * expected + 1013904223U;
  if (result.read(1).front() == expected) return {};
  return "a loop of " + std::to_string(rounds) + " rounds does not reach its end";
}

}  // namespace quadedge::stages
