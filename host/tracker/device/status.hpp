#pragma once
/// \file status.hpp  OpenCL status codes as readable messages, and a process that was forked after OpenCL was
/// used.

#include <string>

#include "quadedge/error.hpp"

namespace quadedge::opencl {

/// Symbolic name of an OpenCL status, for example -54 -> "CL_INVALID_WORK_GROUP_SIZE".
std::string status_name(int status);

/// \throws DeviceError "WHAT failed: CL_... (-N) on DEVICE".
[[noreturn]] void throw_device_error(const std::string& what, int status, const std::string& device);

// Detects a process that was forked after OpenCL was used.

/// Call before the first OpenCL call: processes forked from now on are recognised.
void watch_for_forks();

/// A driver's threads do not exist in a forked child, so its commands would never finish there.
/// \throws DeviceError in a process that was forked after watch_for_forks().
void require_not_forked();

}  // namespace quadedge::opencl
