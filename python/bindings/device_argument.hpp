#pragma once
/// \file device_argument.hpp  The device argument of functions: a name, an index, or a Device object.

#include <memory>
#include <mutex>
#include <string>

#include "bindings.hpp"
#include "quadedge/device.hpp"

namespace quadedge::python {

/// The choice that Device's constructor takes, from a str or an int. \throws TypeError for anything else.
std::string device_choice(nb::handle device);

/// A device shared by several calls, one at a time.
struct SharedDevice {
  Device device;
  std::mutex in_use;
};

/// The device of one call. Construct it with the GIL held.
class DeviceArgument {
 public:
  /// \throws DeviceError when no device matches, TypeError for anything but a str, an int or a Device.
  explicit DeviceArgument(nb::handle device);
  /// Runs `work(Device&)` without the GIL and without any other work on the device.
  template <class Work>
  auto run(const Work& work) {
    const nb::gil_scoped_release released;
    const std::lock_guard<std::mutex> alone(shared_->in_use);
    return work(shared_->device);
  }

 private:
  std::unique_ptr<SharedDevice> own_;
  SharedDevice* shared_ = nullptr;
};

}  // namespace quadedge::python
