/// \file status.cpp  The table of OpenCL's status codes; pthread_atfork() marks children.
#include "device/status.hpp"

#include <map>
#include <mutex>
#include <pthread.h>

#include "quadedge/error.hpp"

namespace quadedge::opencl {

std::string status_name(int status) {
  static const std::map<int, const char*> names = {{0, "CL_SUCCESS"},
                                                   {-1, "CL_DEVICE_NOT_FOUND"},
                                                   {-2, "CL_DEVICE_NOT_AVAILABLE"},
                                                   {-3, "CL_COMPILER_NOT_AVAILABLE"},
                                                   {-4, "CL_MEM_OBJECT_ALLOCATION_FAILURE"},
                                                   {-5, "CL_OUT_OF_RESOURCES"},
                                                   {-6, "CL_OUT_OF_HOST_MEMORY"},
                                                   {-7, "CL_PROFILING_INFO_NOT_AVAILABLE"},
                                                   {-8, "CL_MEM_COPY_OVERLAP"},
                                                   {-11, "CL_BUILD_PROGRAM_FAILURE"},
                                                   {-12, "CL_MAP_FAILURE"},
                                                   {-13, "CL_MISALIGNED_SUB_BUFFER_OFFSET"},
                                                   {-14, "CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST"},
                                                   {-15, "CL_COMPILE_PROGRAM_FAILURE"},
                                                   {-17, "CL_LINK_PROGRAM_FAILURE"},
                                                   {-19, "CL_KERNEL_ARG_INFO_NOT_AVAILABLE"},
                                                   {-30, "CL_INVALID_VALUE"},
                                                   {-31, "CL_INVALID_DEVICE_TYPE"},
                                                   {-32, "CL_INVALID_PLATFORM"},
                                                   {-33, "CL_INVALID_DEVICE"},
                                                   {-34, "CL_INVALID_CONTEXT"},
                                                   {-35, "CL_INVALID_QUEUE_PROPERTIES"},
                                                   {-36, "CL_INVALID_COMMAND_QUEUE"},
                                                   {-38, "CL_INVALID_MEM_OBJECT"},
                                                   {-42, "CL_INVALID_BINARY"},
                                                   {-43, "CL_INVALID_BUILD_OPTIONS"},
                                                   {-44, "CL_INVALID_PROGRAM"},
                                                   {-45, "CL_INVALID_PROGRAM_EXECUTABLE"},
                                                   {-46, "CL_INVALID_KERNEL_NAME"},
                                                   {-47, "CL_INVALID_KERNEL_DEFINITION"},
                                                   {-48, "CL_INVALID_KERNEL"},
                                                   {-49, "CL_INVALID_ARG_INDEX"},
                                                   {-50, "CL_INVALID_ARG_VALUE"},
                                                   {-51, "CL_INVALID_ARG_SIZE"},
                                                   {-52, "CL_INVALID_KERNEL_ARGS"},
                                                   {-53, "CL_INVALID_WORK_DIMENSION"},
                                                   {-54, "CL_INVALID_WORK_GROUP_SIZE"},
                                                   {-55, "CL_INVALID_WORK_ITEM_SIZE"},
                                                   {-56, "CL_INVALID_GLOBAL_OFFSET"},
                                                   {-57, "CL_INVALID_EVENT_WAIT_LIST"},
                                                   {-58, "CL_INVALID_EVENT"},
                                                   {-59, "CL_INVALID_OPERATION"},
                                                   {-61, "CL_INVALID_BUFFER_SIZE"},
                                                   {-63, "CL_INVALID_GLOBAL_WORK_SIZE"},
                                                   {-64, "CL_INVALID_PROPERTY"},
                                                   {-1001, "CL_PLATFORM_NOT_FOUND_KHR"}};
  const auto found = names.find(status);
  return found == names.end() ? "unknown OpenCL status" : found->second;
}

void throw_device_error(const std::string& what, int status, const std::string& device) {
  throw DeviceError(what + " failed: " + status_name(status) + " (" + std::to_string(status) + ") on " + device);
}

namespace {

bool is_forked_child = false;  // written only by a child that has a single thread

}  // namespace

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
