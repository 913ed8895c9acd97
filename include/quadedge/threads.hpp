#pragma once
/// \file threads.hpp  How many threads this process computes with.

namespace quadedge {

/// At most `count` threads for the library's loops and for OpenCL on CPUs (PoCL, Intel's runtime), by TBB's global
/// control and by the environment variables that these runtimes read when they start: to be called before the first
/// Device and before other threads start. Results do not depend on it. 0 sets no limit: PoCL's threads stay each on
/// one processor if this process may use all (POCL_AFFINITY, unless set). \throws UsageError for a negative number
void limit_threads(int count);

}  // namespace quadedge
