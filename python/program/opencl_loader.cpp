/// \file opencl_loader.cpp  The OpenCL functions that the library calls, forwarded to libOpenCL.so.1 when the first one
/// is called.
///
/// A module that names libOpenCL among its dependencies cannot even be imported where there is none, and a wheel cannot
/// depend on a system package. Without the loader there are no platforms, and so no device but the plain C++ reference;
/// the other functions are only called with what a platform has returned. The linker drops libOpenCL as not needed as
/// long as every function that the library uses is defined here; tests/python/test_loader.py checks that.

#include <CL/cl.h>
#include <CL/cl_ext.h>
#include <cstdlib>
#include <dlfcn.h>
#include <string>

namespace {

template <class Function>
Function* find_in(void* library, const char* name, Function*) {
  return library == nullptr ? nullptr : reinterpret_cast<Function*>(dlsym(library, name));
}

bool has_device(void* library) {
  const auto platforms_of = find_in(library, "clGetPlatformIDs", &clGetPlatformIDs);
  const auto devices_of = find_in(library, "clGetDeviceIDs", &clGetDeviceIDs);
  if (platforms_of == nullptr || devices_of == nullptr) return false;
  cl_platform_id platforms[16];
  cl_uint count = 0;
  if (platforms_of(16, platforms, &count) != CL_SUCCESS) return false;
  for (cl_uint i = 0; i < count && i < 16; ++i) {
    cl_uint devices = 0;
    if (devices_of(platforms[i], CL_DEVICE_TYPE_ALL, 0, nullptr, &devices) == CL_SUCCESS && devices > 0) return true;
  }
  return false;
}

/// The system's loader. Where it is missing or has no device, the loader of the runtime that QUADEDGE_OPENCL_RUNTIME
/// names: a driver's library with a libOpenCL.so.1 beside it, which the Python package finds
/// (quadedge/opencl_runtime.py).
void* open_loader() {
  constexpr const char* kName = "libOpenCL.so.1";
  void* const system = dlopen(kName, RTLD_NOW | RTLD_LOCAL);
  const char* const runtime = std::getenv("QUADEDGE_OPENCL_RUNTIME");
  if (runtime == nullptr || *runtime == '\0' || has_device(system)) return system;
  // The driver first: it finds its libraries beside itself, and the loader, which cannot, then uses the same.
  if (dlopen(runtime, RTLD_NOW | RTLD_LOCAL) == nullptr) return system;
  setenv("OCL_ICD_FILENAMES", runtime, 0);
  const std::string file = runtime;
  void* const loader = dlopen((file.substr(0, file.rfind('/') + 1) + kName).c_str(), RTLD_NOW | RTLD_LOCAL);
  return loader == nullptr ? system : loader;
}

/// The loader's own function of that name; null without one.
template <class Function>
Function* find(const char* name, Function* kind) {
  static void* const library = open_loader();
  return find_in(library, name, kind);
}

}  // namespace

#define FORWARD(Result, name, parameters, arguments) \
  extern "C" Result name parameters {                \
    static const auto function = find(#name, &name); \
    return function arguments;                       \
  }

extern "C" cl_int clGetPlatformIDs(cl_uint entries, cl_platform_id* platforms, cl_uint* count) {
  static const auto function = find("clGetPlatformIDs", &clGetPlatformIDs);
  return function == nullptr ? CL_PLATFORM_NOT_FOUND_KHR : function(entries, platforms, count);
}

FORWARD(cl_int, clGetPlatformInfo,
        (cl_platform_id platform, cl_platform_info what, size_t size, void* value, size_t* written),
        (platform, what, size, value, written))
FORWARD(cl_int, clGetDeviceIDs,
        (cl_platform_id platform, cl_device_type type, cl_uint entries, cl_device_id* devices, cl_uint* count),
        (platform, type, entries, devices, count))
FORWARD(cl_int, clGetDeviceInfo, (cl_device_id device, cl_device_info what, size_t size, void* value, size_t* written),
        (device, what, size, value, written))
FORWARD(cl_int, clRetainDevice, (cl_device_id device), (device))
FORWARD(cl_int, clReleaseDevice, (cl_device_id device), (device))

FORWARD(cl_context, clCreateContext,
        (const cl_context_properties* properties, cl_uint count, const cl_device_id* devices,
         void(CL_CALLBACK* notify)(const char*, const void*, size_t, void*), void* data, cl_int* status),
        (properties, count, devices, notify, data, status))
FORWARD(cl_int, clReleaseContext, (cl_context context), (context))
FORWARD(cl_command_queue, clCreateCommandQueue,
        (cl_context context, cl_device_id device, cl_command_queue_properties properties, cl_int* status),
        (context, device, properties, status))
FORWARD(cl_int, clReleaseCommandQueue, (cl_command_queue queue), (queue))
FORWARD(cl_int, clFlush, (cl_command_queue queue), (queue))
FORWARD(cl_int, clFinish, (cl_command_queue queue), (queue))

FORWARD(cl_program, clCreateProgramWithSource,
        (cl_context context, cl_uint count, const char** texts, const size_t* lengths, cl_int* status),
        (context, count, texts, lengths, status))
FORWARD(cl_program, clCreateProgramWithBinary,
        (cl_context context, cl_uint count, const cl_device_id* devices, const size_t* lengths,
         const unsigned char** binaries, cl_int* of_binaries, cl_int* status),
        (context, count, devices, lengths, binaries, of_binaries, status))
FORWARD(cl_int, clBuildProgram,
        (cl_program program, cl_uint count, const cl_device_id* devices, const char* options,
         void(CL_CALLBACK* notify)(cl_program, void*), void* data),
        (program, count, devices, options, notify, data))
FORWARD(cl_int, clGetProgramInfo, (cl_program program, cl_program_info what, size_t size, void* value, size_t* written),
        (program, what, size, value, written))
FORWARD(cl_int, clGetProgramBuildInfo,
        (cl_program program, cl_device_id device, cl_program_build_info what, size_t size, void* value,
         size_t* written),
        (program, device, what, size, value, written))
FORWARD(cl_int, clRetainProgram, (cl_program program), (program))
FORWARD(cl_int, clReleaseProgram, (cl_program program), (program))

FORWARD(cl_kernel, clCreateKernel, (cl_program program, const char* name, cl_int* status), (program, name, status))
FORWARD(cl_int, clGetKernelInfo, (cl_kernel kernel, cl_kernel_info what, size_t size, void* value, size_t* written),
        (kernel, what, size, value, written))
FORWARD(cl_int, clGetKernelWorkGroupInfo,
        (cl_kernel kernel, cl_device_id device, cl_kernel_work_group_info what, size_t size, void* value,
         size_t* written),
        (kernel, device, what, size, value, written))
FORWARD(cl_int, clGetKernelArgInfo,
        (cl_kernel kernel, cl_uint index, cl_kernel_arg_info what, size_t size, void* value, size_t* written),
        (kernel, index, what, size, value, written))
FORWARD(cl_int, clSetKernelArg, (cl_kernel kernel, cl_uint index, size_t size, const void* value),
        (kernel, index, size, value))
FORWARD(cl_int, clReleaseKernel, (cl_kernel kernel), (kernel))
FORWARD(cl_int, clEnqueueNDRangeKernel,
        (cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t* offset, const size_t* global,
         const size_t* local, cl_uint waits, const cl_event* wait_list, cl_event* event),
        (queue, kernel, dimensions, offset, global, local, waits, wait_list, event))

FORWARD(cl_mem, clCreateBuffer, (cl_context context, cl_mem_flags flags, size_t size, void* host, cl_int* status),
        (context, flags, size, host, status))
FORWARD(cl_mem, clCreateSubBuffer,
        (cl_mem buffer, cl_mem_flags flags, cl_buffer_create_type type, const void* region, cl_int* status),
        (buffer, flags, type, region, status))
FORWARD(cl_int, clReleaseMemObject, (cl_mem memory), (memory))
FORWARD(void*, clEnqueueMapBuffer,
        (cl_command_queue queue, cl_mem buffer, cl_bool blocking, cl_map_flags flags, size_t offset, size_t size,
         cl_uint waits, const cl_event* wait_list, cl_event* event, cl_int* status),
        (queue, buffer, blocking, flags, offset, size, waits, wait_list, event, status))
FORWARD(cl_int, clEnqueueUnmapMemObject,
        (cl_command_queue queue, cl_mem memory, void* mapped, cl_uint waits, const cl_event* wait_list,
         cl_event* event),
        (queue, memory, mapped, waits, wait_list, event))
FORWARD(cl_int, clEnqueueFillBuffer,
        (cl_command_queue queue, cl_mem buffer, const void* pattern, size_t pattern_size, size_t offset, size_t size,
         cl_uint waits, const cl_event* wait_list, cl_event* event),
        (queue, buffer, pattern, pattern_size, offset, size, waits, wait_list, event))
FORWARD(cl_int, clEnqueueReadBuffer,
        (cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset, size_t size, void* values,
         cl_uint waits, const cl_event* wait_list, cl_event* event),
        (queue, buffer, blocking, offset, size, values, waits, wait_list, event))
FORWARD(cl_int, clEnqueueWriteBuffer,
        (cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset, size_t size, const void* values,
         cl_uint waits, const cl_event* wait_list, cl_event* event),
        (queue, buffer, blocking, offset, size, values, waits, wait_list, event))
FORWARD(cl_int, clEnqueueWriteBufferRect,
        (cl_command_queue queue, cl_mem buffer, cl_bool blocking, const size_t* buffer_origin, const size_t* origin,
         const size_t* region, size_t buffer_row, size_t buffer_slice, size_t row, size_t slice, const void* values,
         cl_uint waits, const cl_event* wait_list, cl_event* event),
        (queue, buffer, blocking, buffer_origin, origin, region, buffer_row, buffer_slice, row, slice, values, waits,
         wait_list, event))
FORWARD(cl_int, clGetEventProfilingInfo,
        (cl_event event, cl_profiling_info what, size_t size, void* value, size_t* written),
        (event, what, size, value, written))
FORWARD(cl_int, clReleaseEvent, (cl_event event), (event))
