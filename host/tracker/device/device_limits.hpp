#pragma once
/// \file device_limits.hpp  Devices that are smaller than the real one or fail: for tests and for lists of programs.

#include <cstddef>
#include <optional>
#include <string>

#include "quadedge/device.hpp"

namespace quadedge::opencl {

/// Restricts a device. Unset members keep the value of the device.
struct DeviceLimits {
  std::optional<std::string> type;         ///< cpu | gpu | accelerator
  std::optional<std::size_t> group_items;  ///< maximum number of work-items of a work-group
  /// Local memory of a work-group [bytes]; 0: local memory is emulated in global memory.
  std::optional<std::size_t> local_bytes;
  std::optional<std::size_t> memory_bytes;
  std::optional<bool> stores_bytes;       ///< cl_khr_byte_addressable_store
  std::optional<bool> exact_divide_sqrt;  ///< CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT
  std::optional<std::size_t> launches;    ///< kernel launches that succeed before the device is lost
};

/// Opens a device as Device's constructor does and restricts it. \throws DeviceError
Device open_limited(const std::string& choice, const DeviceOptions& options, const DeviceLimits& limits);

}  // namespace quadedge::opencl
