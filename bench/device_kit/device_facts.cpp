/// \file device_facts.cpp  What a driver says about its device, and which libraries this process has loaded.
#include <CL/opencl.hpp>
#include <fstream>
#include <set>
#include <sstream>

#include "device_kit/parts.hpp"
#include "opencl/context.hpp"

namespace device_kit {
namespace {

std::string float_support(cl_device_fp_config config) {
  constexpr std::pair<cl_device_fp_config, const char*> kBits[] = {
      {CL_FP_DENORM, "denormals"},
      {CL_FP_INF_NAN, "infinity and NaN"},
      {CL_FP_ROUND_TO_NEAREST, "round to nearest"},
      {CL_FP_ROUND_TO_ZERO, "round to zero"},
      {CL_FP_ROUND_TO_INF, "round to infinity"},
      {CL_FP_FMA, "FMA"},
      {CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT, "correctly rounded division and square root"},
      {CL_FP_SOFT_FLOAT, "in software"}};
  std::string words;
  for (const auto& [bit, word] : kBits)
    if ((config & bit) != 0) words += (words.empty() ? "" : ", ") + std::string(word);
  return words.empty() ? "none" : words;
}

template <class T>
std::string text(const T& value) {
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

/// Every shared library of this process, without those of the C library.
std::string loaded_libraries() {
  std::ifstream maps("/proc/self/maps");
  std::set<std::string> files;
  for (std::string line; std::getline(maps, line);) {
    const auto slash = line.find('/');
    if (slash != std::string::npos && line.find(".so", slash) != std::string::npos) files.insert(line.substr(slash));
  }
  std::string names;
  for (const auto& file : files) names += (names.empty() ? "" : " ") + file;
  return names;
}

/// A group's size that the device schedules as one, of a kernel with nothing in it.
std::string scheduled_together(const quadedge::opencl::Context& context) {
  cl::Program program(context.context(),
                      std::string("kernel void nothing(global int* x) { x[get_global_id(0)] = 0; }"));
  program.build({context.device()});
  return text(
      cl::Kernel(program, "nothing").getWorkGroupInfo<CL_KERNEL_PREFERRED_WORK_GROUP_SIZE_MULTIPLE>(context.device()));
}

}  // namespace

void device_part(const Options& options) {
  const Device device = options.open_device(true);
  const cl::Device& opencl = device.context()->device();
  const auto add = [&](const char* property, const std::string& value) {
    options.rows.add("device", {{"property", property}, {"value", value}});
  };
  add("name", device.info().name);
  add("platform", device.info().platform);
  add("vendor", opencl.getInfo<CL_DEVICE_VENDOR>());
  add("driver", device.info().driver);
  add("OpenCL", device.info().opencl + ", " + opencl.getInfo<CL_DEVICE_OPENCL_C_VERSION>());
  add("type", device.info().type);
  add("compute units", text(opencl.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>()));
  add("clock [MHz]", text(opencl.getInfo<CL_DEVICE_MAX_CLOCK_FREQUENCY>()));
  add("single precision", float_support(opencl.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>()));
  add("double precision", float_support(opencl.getInfo<CL_DEVICE_DOUBLE_FP_CONFIG>()));
  add("largest group", text(opencl.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>()));
  add("work-items scheduled together", scheduled_together(*device.context()));
  add("local memory [B]", text(opencl.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>()) +
                              (opencl.getInfo<CL_DEVICE_LOCAL_MEM_TYPE>() == CL_LOCAL ? "" : ", in global memory"));
  add("global memory [MB]", text(opencl.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>() >> 20U));
  add("largest buffer [MB]", text(opencl.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>() >> 20U));
  add("cache [kB]", text(opencl.getInfo<CL_DEVICE_GLOBAL_MEM_CACHE_SIZE>() >> 10U));
  add("constant memory [kB]", text(opencl.getInfo<CL_DEVICE_MAX_CONSTANT_BUFFER_SIZE>() >> 10U));
  add("bytes of kernel arguments", text(opencl.getInfo<CL_DEVICE_MAX_PARAMETER_SIZE>()));
  add("timer resolution [ns]", text(opencl.getInfo<CL_DEVICE_PROFILING_TIMER_RESOLUTION>()));
  add("queue out of order",
      (opencl.getInfo<CL_DEVICE_QUEUE_PROPERTIES>() & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE) != 0 ? "yes" : "no");
  add("address bits", text(opencl.getInfo<CL_DEVICE_ADDRESS_BITS>()));
  add("extensions", opencl.getInfo<CL_DEVICE_EXTENSIONS>());
  add("libraries", loaded_libraries());
}

}  // namespace device_kit
