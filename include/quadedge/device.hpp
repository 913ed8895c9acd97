#pragma once
/// \file device.hpp  Lists and opens OpenCL devices.

#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace quadedge {

/// What a device offers in single precision (CL_DEVICE_SINGLE_FP_CONFIG).
struct FloatSupport {
  bool fma = false;  ///< fused multiply-add with one rounding
  bool denormals = false;
  bool rounds_to_nearest = false, rounds_to_zero = false, rounds_to_infinity = false;
  /// Division and square root can be rounded correctly; kernels are then built to do so. Without it results may differ
  /// from those of other devices in the last bits, and the self-test decides by its tolerance.
  bool exact_divide_sqrt = false;
};

/// Properties that a device reports.
struct DeviceInfo {
  int index = 0;  ///< consecutive number over all platforms, as printed by `quadedge devices`
  std::string platform;
  std::string name;
  std::string driver;
  std::string opencl;  ///< version string
  std::string type;    ///< cpu | gpu | accelerator | reference
  unsigned compute_units = 0;
  unsigned long long memory_bytes = 0;
  FloatSupport single_precision;
};

/// All OpenCL devices in a fixed order; empty if there is none. Does not throw if no driver is installed.
std::vector<DeviceInfo> list_devices();

/// `devices` in the order in which the choice "auto" prefers them: GPUs, then CPUs, then all others.
std::vector<DeviceInfo> by_preference(std::vector<DeviceInfo> devices);

/// Options for opening a device.
struct DeviceOptions {
  std::string kernel_folder;   ///< folder that kernels are read from; empty: the embedded kernels
  std::string program_folder;  ///< folder that caches built programs between processes; empty: no cache
  bool profiling = false;
};

class Device;

namespace opencl {
class Context;
struct DeviceLimits;
Device open_limited(const std::string& choice, const DeviceOptions& options, const DeviceLimits& limits);
}  // namespace opencl

/// An open device: an OpenCL context with its queue and built kernels, or the C++ reference of quadedge::quadedge.
/// Objects in several threads may share one; their calls then wait for one another.
class Device {
 public:
  /// `choice`: auto (first GPU, else first CPU), cpu, gpu, reference, an index of list_devices(), or a part of the
  /// platform's or the device's name (case-insensitive). \throws DeviceError with installation instructions and the
  /// list of devices if nothing matches, if it cannot store single bytes, for `reference` without quadedge::quadedge.
  explicit Device(const std::string& choice = "auto", const DeviceOptions& options = {});
  ~Device();
  Device(Device&&) noexcept;
  Device& operator=(Device&&) noexcept;

  const DeviceInfo& info() const { return info_; }
  bool is_reference() const { return context_ == nullptr; }
  /// Holds the device for a call: its queue, kernels and counters are for one thread at a time. Everything that takes a
  /// Device does so itself. The reference device needs no order.
  std::unique_lock<std::recursive_mutex> use() const;
  /// The OpenCL context; null for the reference device.
  opencl::Context* context() const { return context_.get(); }

 private:
  friend Device opencl::open_limited(const std::string&, const DeviceOptions&, const opencl::DeviceLimits&);
  Device(const std::string& choice, const DeviceOptions& options, const opencl::DeviceLimits& limits);

  DeviceInfo info_;
  std::unique_ptr<opencl::Context> context_;
};

}  // namespace quadedge
