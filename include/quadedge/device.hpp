#pragma once
/// \file device.hpp  OpenCL devices: listing and choosing.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace quadedge {

/// What a device says of itself.
struct DeviceInfo {
  int index = 0;  ///< flat number over all platforms, as `quadedge devices` prints it
  std::string platform;
  std::string name;
  std::string driver;
  std::string opencl;  ///< version string
  std::string type;    ///< cpu | gpu | accelerator | reference
  unsigned compute_units = 0;
  unsigned long long memory_bytes = 0;
};

/// All OpenCL devices in a fixed order; empty when there is none. Never throws for a missing driver.
std::vector<DeviceInfo> list_devices();

/// A smaller device than the one at hand, for trying how the program gets by with it. What has no value is the device's
/// own.
struct DeviceLimits {
  std::optional<std::string> type;         ///< cpu | gpu | accelerator
  std::optional<std::size_t> group_items;  ///< work-items of the largest group
  std::optional<std::size_t> local_bytes;  ///< of a group; 0: its local memory lies in global memory
  std::optional<std::size_t> memory_bytes;
  std::optional<bool> stores_bytes;  ///< cl_khr_byte_addressable_store
};

/// How a device is opened.
struct DeviceOptions {
  std::string kernel_folder;   ///< where kernels are read from instead of the embedded ones; empty: these
  std::string program_folder;  ///< where built programs are kept between processes; empty: nowhere
  bool profiling = false;
  DeviceLimits limits;
};

namespace opencl {
class Context;
}

/// A chosen device: an OpenCL context with its queue and built kernels, or the plain C++ reference.
class Device {
 public:
  /// `choice`: auto (first GPU, else first CPU), cpu, gpu, reference, a number of list_devices(), or a text found in
  /// the platform's or the device's name (case does not matter). \throws DeviceError with installation help and the
  /// list of devices when nothing matches, and for a device that cannot store bytes.
  explicit Device(const std::string& choice = "auto", const DeviceOptions& options = {});
  ~Device();
  Device(Device&&) noexcept;
  Device& operator=(Device&&) noexcept;

  const DeviceInfo& info() const { return info_; }
  bool is_reference() const { return context_ == nullptr; }
  /// The OpenCL context; null for the reference.
  opencl::Context* context() const { return context_.get(); }

 private:
  DeviceInfo info_;
  std::unique_ptr<opencl::Context> context_;
};

}  // namespace quadedge
