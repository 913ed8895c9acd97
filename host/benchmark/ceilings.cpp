#include "benchmark/ceilings.hpp"

#include <algorithm>
#include <limits>

#include "opencl/kernel.hpp"
#include "quadedge/error.hpp"

namespace quadedge::bench {
namespace {

constexpr std::size_t kVector = 16;  // floats
constexpr double kRounds = 1024;     // of ceiling_fma, with 8 chains of kVector multiply-adds each

/// Kernel time of what was enqueued since the last call [ms].
double kernel_ms(opencl::Context& context) {
  double sum = 0;
  for (const auto& stage : context.take_profile()) sum += stage.kernel_ms;
  return sum;
}

}  // namespace

Ceilings measure_ceilings(opencl::Context& context, int megabytes, int repetitions) {
  if (!context.profiling()) throw UsageError("ceilings need a profiling queue");
  const std::size_t units = context.device().getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
  // A CPU walks through long rows with a few work-items, a GPU needs many.
  const std::size_t local = context.is_cpu() ? 1 : 128, items = context.is_cpu() ? units * 8 : units * 16 * local;
  const auto program = context.program({"ceilings.cl"}, {{"CHUNK", context.is_cpu() ? "2" : "1"}});
  const opencl::Kernel<opencl::In<cl_float>, cl_int, opencl::Out<cl_float>> copy(context, program, "ceiling_copy");
  const opencl::Kernel<cl_float, opencl::Out<cl_float>> fma(context, program, "ceiling_fma");

  const std::size_t floats = static_cast<std::size_t>(megabytes) * 1024 * 1024 / sizeof(cl_float) / kVector * kVector;
  opencl::Buffer<cl_float> source(context, floats), target(context, floats), sums(context, items);
  source.fill(1.0F, floats);
  target.fill(0.0F, floats);
  context.begin_stage("ceilings");
  double copy_ms = std::numeric_limits<double>::infinity(), fma_ms = copy_ms;
  kernel_ms(context);
  for (int i = 0; i <= repetitions; ++i) {
    copy({items, local}, source, static_cast<cl_int>(floats / kVector), target);
    const double copied = kernel_ms(context);
    fma({items, local}, 0.999F, sums);
    const double added = kernel_ms(context);
    if (i == 0) continue;  // to get warm
    copy_ms = std::min(copy_ms, copied);
    fma_ms = std::min(fma_ms, added);
  }
  Ceilings result;
  result.bandwidth_gb_s = 2.0 * static_cast<double>(floats * sizeof(cl_float)) / (copy_ms * 1e6);
  result.arithmetic_gflop_s = 2.0 * kRounds * 8 * kVector * static_cast<double>(items) / (fma_ms * 1e6);
  return result;
}

}  // namespace quadedge::bench
