/// \file lost_device.cpp  Preloaded before OpenCL's loader: the device is lost after QUADEDGE_TEST_LAUNCHES launches.
#include <CL/cl.h>
#include <atomic>
#include <cstdlib>
#include <dlfcn.h>

extern "C" cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                                         const std::size_t* offset, const std::size_t* global, const std::size_t* local,
                                         cl_uint waits, const cl_event* list, cl_event* event) {
  static std::atomic<long> launches = 0;
  const char* most = std::getenv("QUADEDGE_TEST_LAUNCHES");
  if (most != nullptr && ++launches > std::atol(most)) return CL_OUT_OF_RESOURCES;
  static const auto next =
      reinterpret_cast<decltype(&clEnqueueNDRangeKernel)>(dlsym(RTLD_NEXT, "clEnqueueNDRangeKernel"));
  return next(queue, kernel, dimensions, offset, global, local, waits, list, event);
}
