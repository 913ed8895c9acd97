/// \file status.cpp  The table of OpenCL's status codes; pthread_atfork() marks children.
#include "device/status.hpp"

#include <CL/opencl.hpp>
#include <initializer_list>
#include <mutex>
#include <pthread.h>

#include "quadedge/error.hpp"

namespace quadedge::opencl {
namespace {

bool is_forked_child = false;  // written only by a child that has a single thread

/// The name of `status`. \param names of the codes, one behind the other, separated by ", "
std::string name_in(std::initializer_list<int> codes, const std::string& names, int status) {
  std::size_t begin = 0;
  for (const int code : codes) {
    const std::size_t end = names.find(", ", begin);
    if (code == status) return names.substr(begin, end - begin);
    begin = end + 2;
  }
  return "unknown OpenCL status";
}

}  // namespace

std::string status_name(int status) {
#define NAME_AMONG(...) name_in({__VA_ARGS__}, #__VA_ARGS__, status)
  return NAME_AMONG(CL_SUCCESS, CL_DEVICE_NOT_FOUND, CL_DEVICE_NOT_AVAILABLE, CL_COMPILER_NOT_AVAILABLE,
                    CL_MEM_OBJECT_ALLOCATION_FAILURE, CL_OUT_OF_RESOURCES, CL_OUT_OF_HOST_MEMORY,
                    CL_PROFILING_INFO_NOT_AVAILABLE, CL_MEM_COPY_OVERLAP, CL_BUILD_PROGRAM_FAILURE, CL_MAP_FAILURE,
                    CL_MISALIGNED_SUB_BUFFER_OFFSET, CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST,
                    CL_COMPILE_PROGRAM_FAILURE, CL_LINK_PROGRAM_FAILURE, CL_KERNEL_ARG_INFO_NOT_AVAILABLE,
                    CL_INVALID_VALUE, CL_INVALID_DEVICE_TYPE, CL_INVALID_PLATFORM, CL_INVALID_DEVICE,
                    CL_INVALID_CONTEXT, CL_INVALID_QUEUE_PROPERTIES, CL_INVALID_COMMAND_QUEUE, CL_INVALID_MEM_OBJECT,
                    CL_INVALID_BINARY, CL_INVALID_BUILD_OPTIONS, CL_INVALID_PROGRAM, CL_INVALID_PROGRAM_EXECUTABLE,
                    CL_INVALID_KERNEL_NAME, CL_INVALID_KERNEL_DEFINITION, CL_INVALID_KERNEL, CL_INVALID_ARG_INDEX,
                    CL_INVALID_ARG_VALUE, CL_INVALID_ARG_SIZE, CL_INVALID_KERNEL_ARGS, CL_INVALID_WORK_DIMENSION,
                    CL_INVALID_WORK_GROUP_SIZE, CL_INVALID_WORK_ITEM_SIZE, CL_INVALID_GLOBAL_OFFSET,
                    CL_INVALID_EVENT_WAIT_LIST, CL_INVALID_EVENT, CL_INVALID_OPERATION, CL_INVALID_BUFFER_SIZE,
                    CL_INVALID_GLOBAL_WORK_SIZE, CL_INVALID_PROPERTY, CL_PLATFORM_NOT_FOUND_KHR);
#undef NAME_AMONG
}

void throw_device_error(const std::string& what, int status, const std::string& device) {
  throw DeviceError(what + " failed: " + status_name(status) + " (" + std::to_string(status) + ") on " + device);
}

void watch_for_forks() {
  static std::once_flag registered;
  std::call_once(registered, [] { pthread_atfork(nullptr, nullptr, [] { is_forked_child = true; }); });
}

void require_not_forked() {
  if (!is_forked_child) return;
  throw DeviceError(
      "this process was forked after its parent had used OpenCL, and the driver's threads do not survive a fork. Start "
      "worker processes with exec (Python: multiprocessing.get_context(\"spawn\")), or fork before the first use of "
      "OpenCL. The device \"reference\" works in forked processes");
}

}  // namespace quadedge::opencl
