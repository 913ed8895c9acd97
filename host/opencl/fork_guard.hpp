#pragma once
/// \file fork_guard.hpp  Detects a process that was forked after OpenCL was used.

namespace quadedge::opencl {

/// Call before the first OpenCL call: processes forked from now on are recognised.
void watch_for_forks();

/// A driver's threads do not exist in a forked child, so its commands would never finish there.
/// \throws DeviceError in a process that was forked after watch_for_forks().
void require_not_forked();

}  // namespace quadedge::opencl
