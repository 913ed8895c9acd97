#pragma once
/// \file device_argument.hpp  A device as Python gives it: a word, or an object that is used again.

#include <memory>
#include <mutex>
#include <string>

#include "bindings.hpp"
#include "quadedge/device.hpp"

namespace quadedge::python {

/// A device that functions take again and again, one at a time.
struct SharedDevice {
  Device device;
  std::mutex in_use;
};

/// The device of one call. Made with the GIL held, which is released for as long as the call lasts.
class DeviceArgument {
 public:
  /// \throws DeviceError, TypeError for what is neither text nor Device.
  explicit DeviceArgument(nb::handle device);
  /// Runs `work(Device&)` without the GIL, alone on the device.
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
