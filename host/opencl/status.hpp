#pragma once
/// \file status.hpp  OpenCL status codes as readable messages.

#include <string>

#include "quadedge/error.hpp"

namespace quadedge::opencl {

/// Symbolic name of an OpenCL status, for example -54 -> "CL_INVALID_WORK_GROUP_SIZE".
std::string status_name(int status);

/// \throws DeviceError "WHAT failed: CL_... (-N) on DEVICE".
[[noreturn]] void throw_device_error(const std::string& what, int status, const std::string& device);

}  // namespace quadedge::opencl
