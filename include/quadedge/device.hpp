#pragma once
/// \file device.hpp  OpenCL devices: listing and choosing.

#include <memory>
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

namespace opencl {
class Context;
}

/// A chosen device: an OpenCL context with its queue and built kernels, or the plain C++ reference.
class Device {
 public:
  /// `choice`: auto (first GPU, else first CPU), cpu, gpu, reference, a number of list_devices(), or a text found in
  /// the platform's or the device's name (case does not matter). `kernel_folder`: when not empty, kernels are read from
  /// there instead of the embedded ones. \throws DeviceError with installation help and the list of devices when
  /// nothing matches.
  explicit Device(const std::string& choice = "auto", const std::string& kernel_folder = "", bool profiling = false);
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
