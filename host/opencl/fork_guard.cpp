#include "opencl/fork_guard.hpp"

#include <mutex>
#include <pthread.h>

#include "quadedge/error.hpp"

namespace quadedge::opencl {
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
