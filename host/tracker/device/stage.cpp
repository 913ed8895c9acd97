/// \file stage.cpp  One group scans short lists, many scan long ones; a long loop is checked on the host.
#include "device/stage.hpp"

namespace quadedge::stages {
namespace {

constexpr std::size_t kGroups = 32, kSingleItems = 8;  // of many work-items, of one
constexpr int kSmall = 4096;                           // one group is enough up to here

}  // namespace

Scan::Scan(opencl::Context& context, const opencl::VariantChoice& variants) : Stage(context, "scan", variants) {
  opencl::Defines defines;
  if (is_grouped()) defines["SCAN_LOCAL"] = std::to_string(local_size_);
  kernel_ = {context, variant_.program(context, defines), "scan"};
}

void Scan::run(const opencl::Buffer<cl_int>& counts, int count, int capacity, opencl::Buffer<cl_int>& first,
               opencl::Buffer<cl_int>& total) {
  first.ensure(context_, static_cast<std::size_t>(count) + 1);
  total.ensure(context_, 2);
  const std::size_t groups = count <= kSmall ? 1 : is_grouped() ? kGroups : kSingleItems;
  const std::string user = context_.stage();
  begin();
  kernel_({groups * local_size_, local_size_}, counts, count, capacity, first, total);
  context_.begin_stage(user);
}

std::string long_loop_difference(opencl::Context& context, cl_int rounds) {
  const opencl::Kernel<void(cl_int, cl_uint*)> kernel(context, context.program({"long_loop.cl"}, {}), "long_loop");
  opencl::Buffer<cl_uint> result(context, 1);
  kernel({1, 1}, rounds, result);
  cl_uint expected = 1;
  for (cl_int i = 0; i < rounds; ++i) expected = 1664525U * expected + 1013904223U;
  if (result.read(1).front() == expected) return {};
  return "a loop of " + std::to_string(rounds) + " rounds does not reach its end";
}

}  // namespace quadedge::stages
