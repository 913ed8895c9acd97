#pragma once
/// \file arguments.hpp  Arguments of functions: rigs, configurations and devices; Trajectory and rendered sequences as
/// classes of their own.

#include <memory>
#include <mutex>
#include <nanobind/stl/bind_vector.h>
#include <string>

#include "bindings.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/device.hpp"
#include "quadedge/synthetic.hpp"
#include "quadedge/trajectory.hpp"

NB_MAKE_OPAQUE(quadedge::Trajectory)

namespace quadedge::python {

/// From a Rig, a Dataset or a Synthetic. \throws TypeError for anything else.
StereoRig rig_of(nb::handle source);

/// A path, or two paths joined by a comma, as the library takes them; None becomes "". \throws TypeError.
std::string files_of(nb::handle files);

/// A preset with the values of `config`: a dictionary, the path of a TOML file, or None.
/// \throws UsageError for an unknown preset or key and for a value of another type or out of range; TypeError.
Config make_config(const std::string& preset, nb::handle config);

/// All values by key, and "variant" where kernel variants are chosen.
nb::dict to_dict(const Config& config);

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
    const ReleasedGil released;
    const std::lock_guard<std::mutex> alone(shared_->in_use);
    return work(shared_->device);
  }

 private:
  std::unique_ptr<SharedDevice> own_;
  SharedDevice* shared_ = nullptr;
};

struct RenderedSequence : SyntheticSequence {
  explicit RenderedSequence(const SyntheticOptions& what) : SyntheticSequence(what), options(what) {}
  SyntheticOptions options;
};

}  // namespace quadedge::python
