/// \file threads.cpp  Limits TBB by a global control, OpenCL on CPUs by environment variables of PoCL and Intel.
#include "quadedge/threads.hpp"

#include <cstdlib>
#include <memory>
#include <string>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <unistd.h>

#include "quadedge/error.hpp"

namespace quadedge {

void limit_threads(int count) {
  if (count < 0) throw UsageError("threads: found " + std::to_string(count) + ", expected 0 or more");
  if (count == 0 && tbb::info::default_concurrency() == sysconf(_SC_NPROCESSORS_ONLN)) setenv("POCL_AFFINITY", "1", 0);
  if (count == 0) return;
  static std::unique_ptr<tbb::global_control> limit;
  limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                static_cast<std::size_t>(count));
  const std::string text = std::to_string(count);
  // PoCL up to version 3, PoCL from version 4 on, Intel's OpenCL for CPUs.
  for (const char* name : {"POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT", "DPCPP_CPU_NUM_CUS"})
    setenv(name, text.c_str(), 1);
}

}  // namespace quadedge
